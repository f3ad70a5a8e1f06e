// SPDX-License-Identifier: MIT
// Changes of one table constructor in the text of a script, in the layout that it has: nothing is written that the
// change does not need. Pure text.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/lua_text.h"

namespace afterglow::script {

/// A piece of the text that becomes another.
struct Replacement {
  std::size_t offset = 0, length = 0;
  std::string text;
};
using Replacements = std::vector<Replacement>;  ///< by ascending offset, none within another

std::string replaced(std::string_view text, const Replacements& replacements);

/// The last item of that key, the one that counts; empty when there is none.
std::optional<LuaText::Item> find_item(const LuaText& text, std::size_t open, std::string_view key);

/// `key = value` as the last item of the constructor at `open`: on the same line in tables of one line, on a line of
/// its own where all items have one, with the separators, indent and style of key of its neighbours.
Replacements insert_item(const LuaText& text, std::size_t open, const std::string& key, const std::string& value);

/// Without the item, its separator and the line that it leaves empty. Nothing when comments stand around it: they may
/// be about it, and nobody can say what becomes of them.
std::optional<Replacements> remove_item(const LuaText& text, std::size_t open, const LuaText::Item& item);

/// `source` as an item without a key behind item number `behind`, in the layout of that one.
Replacements insert_behind(const LuaText& text, std::size_t open, std::size_t behind, const std::string& source);
/// The same into a constructor without items.
Replacements insert_first(const LuaText& text, std::size_t open, const std::string& source);
/// Without item number `index` and what stands on its own lines behind it: a comment there is about it. Comments on
/// lines of their own stay.
Replacements take_out(const LuaText& text, std::size_t open, std::size_t index);
/// Item number `from` in the place of number `to`, those between one place on; `among` are the items that change
/// places, ascending. Comments right above an item and behind it on its line go with it; separators and layout stay.
Replacements move_item(const LuaText& text, std::size_t open, const std::vector<std::size_t>& among, std::size_t from,
                       std::size_t to);

}  // namespace afterglow::script
