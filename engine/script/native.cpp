#include "script/native.h"

#include "script/key_finder.h"

namespace afterglow::script {

void locate_failure(lua_State* lua, ScriptError& failure, const char* function) {
  if (!failure.error.file.empty()) return;
  const Sandbox& box = Sandbox::of(lua);
  Location where = box.caller(lua);
  if (where.source < 0) return;
  const Source& source = box.sources()[static_cast<std::size_t>(where.source)];
  where.line =
      line_of_key(source.text, where.line, failure.function.empty() ? function : failure.function, failure.key);
  box.locate(failure.error, where);
}

}  // namespace afterglow::script
