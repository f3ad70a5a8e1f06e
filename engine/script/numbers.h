// SPDX-License-Identifier: MIT
// Tables of many numbers, as scripts give them for matrices and arrays of a shader. Internal to the room.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "script/lua.h"

namespace afterglow::script {

/// Rows of numbers, or numbers alone.
struct Numbers {
  std::size_t rows = 0;     ///< 0: it is no such table
  std::size_t columns = 0;  ///< of each row; 0: each is a number, and no table
  std::vector<double> values;
  std::string fault;  ///< why it is none: "has a table of 2 at 3, and a table of 3 before"
};

/// Of a table in which all rows are alike and have four numbers at most, and which has no other keys than 1, 2, ….
/// Of a longer one than `most` rows the beginning, one row more than that, so that whoever takes it can tell.
Numbers read_numbers(lua_State* lua, int index, std::size_t most);

}  // namespace afterglow::script
