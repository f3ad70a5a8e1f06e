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

Error wrong(const std::string& name, const std::string& why, std::string allowed = "") {
  return {ErrorKind::usage, fmt::format("'{}' {}", tidy_message(name, 60), why), "", 0, std::move(allowed)};
}

Result<void> check_identifier(const std::string& name, const char* what) {
  if (script::is_identifier(name)) return {};
  if (name.ends_with(".lua") && script::is_identifier(name.substr(0, name.size() - 4)))
    return wrong(name, fmt::format("cannot be the name of {}", what), name.substr(0, name.size() - 4));
  return wrong(name, fmt::format("cannot be the name of {}", what), "1 to 64 letters, digits and '_', no digit first");
}

}  // namespace

Result<void> check_new_look_name(const std::string& name) { return check_identifier(name, "a look"); }

Result<void> check_new_effect_name(const std::string& name, const SearchPath& path) {
  AFTERGLOW_CHECK(check_identifier(name, "an effect"));
  if (holds(lua_words(), name)) return wrong(name, "is a word of Lua; fx." + name + " could not be written");
  if (holds(script::library_names(), name)) return wrong(name, "is a name of the library: fx." + name);
  if (name == "lib") return wrong(name, "is the folder of shader libraries");
  if (const auto hits = path.find_effect(name); !hits.empty())
    return wrong(name, fmt::format("is an effect already: {}", hits.front().string()));
  return {};
}

}  // namespace afterglow
