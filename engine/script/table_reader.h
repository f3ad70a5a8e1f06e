// SPDX-License-Identifier: MIT
// Reads the one table that the functions of the library take: checks its keys and collects what is wrong, so that the
// failure reported is the first one in the source text, whatever order Lua keeps keys in.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "script/native.h"
#include "script/value.h"

namespace afterglow::script {

class TableReader {
 public:
  /// `index` of the table; `what` names the call in messages: "fx.stack". Throws when it is not a table.
  TableReader(lua_State* lua, int index, std::string what);

  /// A table inside another's: failures go to `parent`, which must outlive it, with `place` before their own key. Empty
  /// when it is not a table, which is a failure.
  TableReader(lua_State* lua, int index, std::string what, TableReader& parent, KeyPath place);

  struct Key {
    std::string name;          ///< "#2" for position 2
    lua_Integer position = 0;  ///< of positional items; else 0
  };
  /// Positions ascending, then names by their bytes. Keys of other types are failures.
  const std::vector<Key>& keys() const { return keys_; }

  /// Pushes the value of a key.
  void push(const Key& key) const;
  void push(const char* name) const;
  /// The value of a name; kind `nothing` when there is none.
  Value value(const char* name) const;

  /// Text, number, … of a name; a failure is noted when it has another type, or a text more bytes. Empty when absent.
  std::optional<std::string> text(const char* name, std::size_t limit = kLongestText);
  std::optional<double> number(const char* name);
  std::optional<int> integer(const char* name);
  std::optional<bool> boolean(const char* name);

  /// Notes a failure for every key that is not among `known`; positional ones are unknown unless `positions`.
  void allow(const std::vector<std::string>& known, bool positions);

  /// Notes a failure; `finish` throws the one that stands first in the source.
  void fail(ScriptError error);
  bool failed() const { return parent_ ? parent_->failed() : !failures_.empty(); }
  void finish(const char* function);

  const std::string& what() const { return what_; }

 private:
  static constexpr std::size_t kMaxFailures = 32;  // each one costs a search of the source

  void read_keys();

  lua_State* lua_;
  int index_;  // 0: no table
  std::string what_;
  TableReader* parent_ = nullptr;
  KeyPath place_;  // in the parent
  std::vector<Key> keys_;
  std::vector<ScriptError> failures_;
};

}  // namespace afterglow::script
