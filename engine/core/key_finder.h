// SPDX-License-Identifier: MIT
// Finds the line of a key in the source text of a call, so that an error can point at `treshold = 1` and not at the
// `fx.glow{` above it. Works on tokens; knows comments, strings, long brackets and nested functions. Pure text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace afterglow {

/// Names the offending place inside the table constructor of a call: {"settings", "mode"} or {"#2"} (second positional
/// item).
using KeyPath = std::vector<std::string>;

/// Line of `key` in the table constructor of the call `function{…}`, `function({…})` or `function("…", {…})` whose
/// bracket opens on `call_line` (any constructor that opens there when the function goes by another name). Falls back
/// to the deepest part of the path that was found, then to `call_line`.
int line_of_key(std::string_view text, int call_line, std::string_view function, const KeyPath& key);

/// A name that one table constructor gives twice: Lua takes the last one, without a word.
struct RepeatedKey {
  std::string key;
  int first = 0, line = 0;  ///< where it stands first, and once more
};
/// Of a script, in the order of the text.
std::vector<RepeatedKey> repeated_keys(std::string_view text);

}  // namespace afterglow
