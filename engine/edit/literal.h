// SPDX-License-Identifier: MIT
// Values as somebody wrote them into a script: telling those apart that can be changed in place from expressions, and
// writing others in the same style.
#pragma once

#include <optional>
#include <string>

#include "core/lua_text.h"
#include "script/preset.h"

namespace afterglow::script {

/// Are the tokens from `first` up to `end` a plain value: a number, text, true, false, nil, or a list of numbers?
bool is_literal(const LuaText& text, std::size_t first, std::size_t end);

/// The value in the style of the literal that stands at these tokens: quotes, digits, hexadecimal numbers, spaces in
/// lists, "#rrggbb" where the colour can be written so. What is read back is the same to 32-bit floats, and to doubles
/// unless the value is a 32-bit float. Of another type of literal only what makes sense is kept.
std::string literal_like(const LuaText& text, std::size_t first, std::size_t end, const SettingValue& value);

/// The value where none stands yet; a colour whose numbers would have many digits as "#rrggbb".
std::string literal_text(const SettingValue& value, char quote = '"', bool spaced = true);

}  // namespace afterglow::script
