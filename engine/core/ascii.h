// SPDX-License-Identifier: MIT
// What kind of character it is, in ASCII, whatever the locale.
#pragma once

namespace afterglow {

constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }
constexpr bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
/// Of a name as Lua and GLSL have it: a letter, a digit or an underscore.
constexpr bool is_name_char(char c) { return is_letter(c) || is_digit(c) || c == '_'; }

}  // namespace afterglow
