// SPDX-License-Identifier: MIT
// What a new effect may be called.
#include <fmt/format.h>

#include <algorithm>

#include "core/text.h"
#include "script/injection.h"
#include "script/runtime.h"

namespace afterglow {
namespace {

// `fx.end {}` could not be written.
const std::vector<std::string>& lua_words() {
  static const std::vector<std::string> words{"and",      "break",  "do",   "else", "elseif", "end",  "false", "for",
                                              "function", "goto",   "if",   "in",   "local",  "nil",  "not",   "or",
                                              "repeat",   "return", "then", "true", "until",  "while"};
  return words;
}

bool holds(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

Result<void> check_new_effect_name(const std::string& name, const SearchPath& path) {
  const auto wrong = [&](const std::string& why, std::string allowed = "") {
    return Error{ErrorKind::usage, fmt::format("'{}' {}", tidy_message(name, 60), why), "", 0,
                 std::move(allowed)};
  };
  if (!script::is_identifier(name))
    return wrong("cannot be the name of an effect", "1 to 64 letters, digits and '_', no digit first");
  if (holds(lua_words(), name)) return wrong("is a word of Lua; fx." + name + " could not be written");
  if (holds(script::library_names(), name)) return wrong("is a name of the library: fx." + name);
  if (name == "lib") return wrong("is the folder of shader libraries");
  if (const auto hits = path.find_effect(name); !hits.empty())
    return wrong(fmt::format("is an effect already: {}", hits.front().string()));
  return {};
}

}  // namespace afterglow
