// SPDX-License-Identifier: MIT
#include "script/native.h"

#include "core/ascii.h"
#include "core/key_finder.h"
#include "script/function_ref.h"

namespace afterglow::script {

void locate_failure(lua_State* lua, ScriptError& failure, const char* function) {
  if (!failure.error.file.empty()) return;
  Sandbox& box = Sandbox::of(lua);
  Location where = box.caller(lua);
  if (where.source < 0) return;
  const Source& source = box.sources()[static_cast<std::size_t>(where.source)];
  box.charge(source.text.size() / 4);  // scripts may fail in a loop
  where.line = afterglow::line_of_key(source.text, where.line, failure.function.empty() ? function : failure.function,
                                      failure.key);
  box.locate(failure.error, where);
}

void locate_blame(const Sandbox& box, const Blame& blame, Error& error) {
  error.file = blame.file;
  error.line = blame.line;
  std::size_t end = 0;
  while (end < error.message.size() && is_name_char(error.message[end])) ++end;
  if (end == 0) return;
  error.line = line_of_key(box, blame.file, blame.line, blame.function, {error.message.substr(0, end)});
}

int line_of_key(const Sandbox& box, const std::string& file, int line, std::string_view function, const KeyPath& key) {
  for (const Source& source : box.sources())
    if (source.path == file) return afterglow::line_of_key(source.text, line, function, key);
  return line;
}

void locate_function(lua_State* lua, const FunctionRef& function, Error& error) {
  lua_rawgeti(lua, LUA_REGISTRYINDEX, function.ref);
  lua_Debug info{};
  lua_getinfo(lua, ">S", &info);
  const Sandbox& box = Sandbox::of(lua);
  box.locate(error, box.location(info.source, info.linedefined));
}

}  // namespace afterglow::script
