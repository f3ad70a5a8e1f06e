// SPDX-License-Identifier: MIT
#include "core/key_finder.h"

#include <map>
#include <vector>

#include "core/lua_text.h"

namespace afterglow {
namespace {

class Finder {
 public:
  Finder(std::string_view text, const KeyPath& key) : text_(text), key_(key) {}

  int find(int call_line, std::string_view function) const {
    int best = call_line;
    std::size_t best_depth = 0;
    // The named function's own brackets first; then any constructor on that line.
    for (const bool named : {true, false}) {
      for (const std::size_t open : named ? tables_of(call_line, function) : tables_on(call_line)) {
        int line = call_line;
        const std::size_t depth = descend(open, 0, line);
        if (depth > best_depth) {
          best = line;
          best_depth = depth;
        }
      }
      if (best_depth == key_.size()) break;
    }
    return best;
  }

 private:
  // Constructors that the calls of the function on that line are given: alone, in brackets, or behind a name.
  std::vector<std::size_t> tables_of(int line, std::string_view function) const {
    std::vector<std::size_t> out;
    for (const auto& call : text_.calls()) {
      if (call.callee != function || !call.at(line)) continue;
      std::size_t open = call.open;
      if (text_.is(open, "(")) open += text_.is(open + 2, ",") ? 3 : 1;
      if (text_.is(open, "{")) out.push_back(open);
    }
    return out;
  }

  // Each walks its items, so there is an end to how many are looked at.
  std::vector<std::size_t> tables_on(int line) const {
    constexpr std::size_t kMost = 64;
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < text_.size() && out.size() < kMost; ++i)
      if (text_[i].line == line && text_.is(i, "{")) out.push_back(i);
    return out;
  }

  // How many parts of the key path are found below the constructor at `open`; `line` becomes that of the deepest.
  std::size_t descend(std::size_t open, std::size_t depth, int& line) const {
    if (depth == key_.size()) return depth;
    std::size_t best = depth;
    for (const auto& item : text_.items(open)) {
      if (item.key != key_[depth]) continue;
      // A key may be given twice: the last one counts for Lua, and here.
      line = text_[item.first].line;
      best = depth + 1;
      if (text_.is(item.value, "{")) best = descend(item.value, depth + 1, line);
    }
    return best;
  }

  LuaText text_;
  const KeyPath& key_;
};

}  // namespace

int line_of_key(std::string_view text, int call_line, std::string_view function, const KeyPath& key) {
  if (key.empty()) return call_line;
  return Finder(text, key).find(call_line, function);
}

std::vector<RepeatedKey> repeated_keys(std::string_view text) {
  const LuaText script(text);
  std::vector<RepeatedKey> out;
  for (std::size_t open = 0; open < script.size(); ++open) {
    if (!script.is(open, "{") || script.partner(open) == LuaText::kNone) continue;
    std::map<std::string, int> lines;
    for (const auto& item : script.items(open)) {
      if (item.key.empty() || item.key.starts_with('#')) continue;
      const int line = script[item.first].line;
      const auto [known, fresh] = lines.emplace(item.key, line);
      if (!fresh) out.push_back({item.key, known->second, line});
    }
  }
  return out;
}

}  // namespace afterglow
