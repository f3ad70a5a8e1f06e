// SPDX-License-Identifier: MIT
// How native functions are given to Lua: C++ exceptions become Lua errors at the caller's file and line.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

#include "script/sandbox.h"

namespace afterglow::script {

/// A string literal as a template argument.
template <std::size_t N>
struct Literal {
  char text[N];
  constexpr Literal(const char (&literal)[N]) { std::copy_n(literal, N, text); }  // NOLINT: converts on purpose
};

/// Fills in file and line of a failure: those of its key in the call's table, else of the call.
void locate_failure(lua_State* lua, ScriptError& failure, const char* function);

/// Line of `key` in the call of `function` that begins at this line of a script; `line` when it is not found.
int line_of_key(const Sandbox& box, const std::string& file, int line, std::string_view function, const KeyPath& key);

/// Points `error` at the blamed call, or at the key of it with which the message begins.
void locate_blame(const Sandbox& box, const Blame& blame, Error& error);

/// `Function` as Lua calls it; `Name` is the last identifier of the call in scripts.
template <int (*Function)(lua_State*), Literal Name>
int native(lua_State* lua) {
  int results = 0;
  Sandbox::guard(lua, [&] {
    try {
      results = Function(lua);
    } catch (ScriptError& error) {
      locate_failure(lua, error, Name.text);
      throw;
    }
  });
  return results;
}

/// Calls the function below `arguments` values on the stack; its errors pass through as they are.
inline void call(lua_State* lua, int arguments, int results) { lua_call(lua, arguments, results); }

}  // namespace afterglow::script
