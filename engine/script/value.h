// SPDX-License-Identifier: MIT
// A value as a script or the command line gave it, before anyone decided what it must be.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "script/lua.h"

namespace afterglow::script {

/// Bytes of the longest text that anything takes. Of a longer one its beginning is read, one byte more than this, so
/// that whoever takes it can tell.
inline constexpr std::size_t kLongestText = 4096;

struct Value {
  enum class Kind { nothing, boolean, number, text, list, other };
  Kind kind = Kind::nothing;
  double number = 0;             ///< number; boolean as 0/1
  std::string text;              ///< text; of `other`: "a function"
  std::array<double, 4> list{};  ///< 1…4 numbers
  int count = 0;                 ///< of `list`

  /// As messages show it: `"soft"`, `1.5`, `{1, 2}`, `a function`.
  std::string shown() const;
};

/// Reads a value from the stack; tables of 1 to 4 numbers are lists, all other tables `other`.
Value read_value(lua_State* lua, int index);

/// "table", "function", or the kind of an object: "image", "stack", ….
std::string kind_name(lua_State* lua, int index);

/// Reads "4", "true", "{1, 2}", "1,2" or plain text, quoted or not.
Value parse_value(const std::string& text);

}  // namespace afterglow::script
