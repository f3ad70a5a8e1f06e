// SPDX-License-Identifier: MIT
// Where the entries of a stack stand in the text of a preset. Pure text.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/lua_text.h"
#include "script/preset.h"

namespace afterglow::script {

/// An item without a key of a table constructor.
struct ListPlace {
  std::size_t open = 0;   ///< token of the constructor's bracket
  std::size_t index = 0;  ///< among all of its items
};

/// Items that may have made the entry, those that fit best first: calls of its effect at its line, calls of other names
/// there, names of variables that such a call was given to.
std::vector<ListPlace> list_places(const LuaText& text, const StackEntry& entry);

/// The tables that stacks are made of, the last one of the text first: arguments of calls named `stack` or `extend`.
std::vector<std::size_t> stack_tables(const LuaText& text);

/// What the script calls the library: "fx".
std::string library_name(const LuaText& text);

/// The items of the constructor that have no key.
std::vector<std::size_t> list_items(const LuaText& text, std::size_t open);

}  // namespace afterglow::script
