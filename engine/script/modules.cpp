// SPDX-License-Identifier: MIT
// Reading scripts: chunks, `require`, and the effects on the search path.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <system_error>

#include "core/ascii.h"
#include "core/file.h"
#include "core/inside.h"
#include "core/near_path.h"
#include "core/text.h"
#include "core/utf16.h"
#include "core/version.h"
#include "script/globals.h"
#include "script/injection.h"
#include "script/native.h"
#include "script/object.h"
#include "script/requirement.h"
#include "script/runtime.h"
#include "script/syntax_hint.h"
#include "script/value.h"

namespace afterglow::script {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kFileCost = 100'000;    // instructions that a look at the file system counts as
constexpr std::size_t kMaxScript = 1u << 20;    // bytes; presets are a page long
constexpr std::size_t kMaxScripts = 16u << 20;  // of one state: their texts live outside of Lua's memory
constexpr const char* kLibrary = "afterglow";   // the module that is no file
const char kModules = 0;                        // registry key of the cache of modules

std::string folder_of(ScriptKind kind) { return kind == ScriptKind::mask ? "masks" : "effects"; }

// Marks a script as being loaded, for the life of the object; `shown` is its name in messages.
class Loading {
 public:
  Loading(Runtime& runtime, std::string key) : Loading(runtime, key, key) {}
  Loading(Runtime& runtime, std::string key, const std::string& shown) : runtime_(runtime), key_(std::move(key)) {
    if (!runtime_.loading.insert(key_).second) throw failure(fmt::format("'{}' needs itself while it loads", shown));
  }
  ~Loading() { runtime_.loading.erase(key_); }
  Loading(const Loading&) = delete;
  Loading& operator=(const Loading&) = delete;

 private:
  Runtime& runtime_;
  std::string key_;
};

// "lib.taps" → "lib/taps.lua"; empty when the name could lead anywhere else.
std::string module_file(const std::string& name) {
  for (const auto& part : split(name, '.'))
    if (!is_identifier(part)) return {};
  std::string file = name;
  std::replace(file.begin(), file.end(), '.', '/');
  return file + ".lua";
}

// "lib/taps.lua" → "lib.taps"; empty when that is no name either.
std::string module_of_file(std::string name) {
  if (name.starts_with("./")) name.erase(0, 2);
  if (name.ends_with(".lua")) name.resize(name.size() - 4);
  std::ranges::replace(name, '/', '.');
  return module_file(name).empty() ? "" : name;
}

// Folders that modules may lie in, for the script that is running: the one that it comes from first, so that what lies
// beside a preset does not change what built-in effects require, nor one pack what another does.
std::vector<fs::path> module_folders(lua_State* lua) {
  const Runtime& runtime = Runtime::of(lua);
  std::vector<fs::path> folders = runtime.path.user;
  folders.push_back(runtime.path.installation / "scripts");
  const Location caller = runtime.box->caller(lua);
  if (caller.source < 0) return folders;
  return own_first(std::move(folders), runtime.box->sources()[static_cast<std::size_t>(caller.source)].path);
}

// What a name that is no module's may mean.
std::string near_module(const std::vector<fs::path>& folders, const std::string& name) {
  const std::string near = module_of_file(near_path(folders, module_file(name)));
  return near.empty() ? nearest_name(name, std::vector<std::string>{kLibrary}) : near;
}

fs::path find_module(const Runtime& runtime, const std::vector<fs::path>& folders, const std::string& name) {
  Sandbox& box = *runtime.box;
  box.charge(kFileCost);
  const Sandbox::Pause pause(box);
  const std::string file = module_file(name);
  if (file.empty())
    throw failure(fmt::format("require: '{}' is not the name of a module", tidy_message(name, 60)), {},
                  "names joined by '.', like \"lib.taps\"", module_of_file(name));
  for (const auto& folder : folders) {
    const fs::path path = folder / file;
    if (!is_file(path, runtime.path.record.get())) continue;
    if (!lies_in(path, folder))
      throw failure(fmt::format("require: '{}' is a link that leads out of {}", name, folder.string()));
    return path;
  }
  throw failure(fmt::format("require: there is no module '{}'", name), {},
                "\"afterglow\", and scripts beside the preset or on the search path", near_module(folders, name));
}

int returns_nothing(lua_State* lua) {
  throw failure(fmt::format("the module {} returns nothing", lua_tostring(lua, lua_upvalueindex(1))), {},
                "a return at its end, of a table of functions or the like");
}

// What a module without a return is: nothing of it can be used, and whoever tries is told why.
void push_nothing(lua_State* lua, const fs::path& file) {
  lua_createtable(lua, 0, 0);
  lua_createtable(lua, 0, 3);
  for (const char* use : {"__index", "__call"}) {
    lua_pushstring(lua, file.c_str());
    lua_pushcclosure(lua, (&native<returns_nothing, "">), 1);
    lua_setfield(lua, -2, use);
  }
  lua_pushboolean(lua, 0);
  lua_setfield(lua, -2, "__metatable");
  lua_setmetatable(lua, -2);
}

// Pushes what the module in a file returns; it runs once, whoever needs it.
void push_module(lua_State* lua, int cache, const fs::path& file, const std::string& name) {
  std::error_code ec;
  const std::string key = fs::weakly_canonical(file, ec).string();
  lua_pushlstring(lua, key.data(), key.size());
  if (lua_rawget(lua, cache) != LUA_TNIL) return;
  lua_pop(lua, 1);
  const Loading loading(Runtime::of(lua), key, name);
  load_chunk(lua, file);
  Runtime::of(lua).modules.push_back(file);
  call(lua, 0, 1);
  if (lua_isnil(lua, -1)) {
    lua_pop(lua, 1);
    push_nothing(lua, file);
  }
  lua_pushvalue(lua, -1);
  lua_setfield(lua, cache, key.c_str());
}

int do_require(lua_State* lua) {
  Runtime& runtime = Runtime::of(lua);
  if (lua_type(lua, 1) != LUA_TSTRING) throw failure("require: the name of a module must be a text");
  std::size_t size = 0;
  const char* text = lua_tolstring(lua, 1, &size);
  const std::string name(text, size);  // with any NUL in it, which no module's name has
  lua_rawgetp(lua, LUA_REGISTRYINDEX, &kModules);
  lua_replace(lua, 1);
  lua_settop(lua, 1);
  if (name == kLibrary) return lua_getfield(lua, 1, kLibrary), 1;
  // What a name means where the script comes from; behind the name of the file it is what that returned.
  const std::vector<fs::path> folders = module_folders(lua);
  const std::string known_as = name + "\n" + folders.front().string();
  lua_pushlstring(lua, known_as.data(), known_as.size());
  if (lua_rawget(lua, 1) != LUA_TNIL) return 1;
  lua_settop(lua, 1);
  if (!runtime.declaring) throw failure("require: can only be used while a script loads");
  push_module(lua, 1, find_module(runtime, folders, name), name);
  lua_pushlstring(lua, known_as.data(), known_as.size());
  lua_pushvalue(lua, -2);
  lua_rawset(lua, 1);
  return 1;
}

}  // namespace

/// Of the script that was read last, a preset: what it needs may be anywhere in it, so it is asked before it runs.
void check_requirement(const Sandbox& box) {
  const Source& source = box.sources().back();
  const auto newer = newer_requirement(source.text, *parse_version(version()));
  if (newer)
    throw ScriptError{{ErrorKind::script,
                       fmt::format("the preset requires Afterglow {}; this is {}", newer->version, version()),
                       source.path, newer->line}};
}

/// A script has returned the value on top of the stack. `made`: it has made what it should return.
ScriptError not_returned(lua_State* lua, const fs::path& file, const char* what, const std::string& function,
                         bool made) {
  const Value value = read_value(lua, -1);
  const std::string shape = fmt::format("fx.{} {{ … }}", function);
  ScriptError error = failure(fmt::format("{} must return {}, not {}", what, shape, value.shown()));
  error.error.file = file.string();
  if (value.kind != Value::Kind::nothing) return error;
  error.error.allowed = fmt::format("return {}, at the end", shape);
  const auto& sources = Sandbox::of(lua).sources();
  const auto source = std::ranges::find(sources, error.error.file, &Source::path);
  if (!made || source == sources.end()) return error;
  const std::size_t at = source->text.rfind("fx." + function);
  if (at == std::string::npos) return error;
  const int line = static_cast<int>(std::ranges::count(std::string_view(source->text).substr(0, at), '\n')) + 1;
  if (!trim(line_of(source->text, line)).starts_with("fx." + function))
    return error;  // not what a statement begins with
  error.error.line = line;
  error.error.message = fmt::format("'return' is missing before fx.{}: {} must return what it makes", function, what);
  error.error.allowed.clear();
  return error;
}

DeclaredStack load_stack(lua_State* lua, const fs::path& file, const std::optional<std::string>& text) {
  Runtime& runtime = Runtime::of(lua);
  std::error_code ec;
  const Loading loading(runtime, "preset " + fs::weakly_canonical(file, ec).string());
  const std::size_t made_before = runtime.stacks.size();
  load_chunk(lua, file, false, text);
  check_requirement(*runtime.box);
  call(lua, 0, 1);
  const Handle* handle = to_object<Handle>(lua, -1, kStackKind);
  if (!handle) throw not_returned(lua, file, "a preset", "stack", runtime.stacks.size() > made_before);
  DeclaredStack stack = runtime.stacks[static_cast<std::size_t>(handle->index)];
  lua_pop(lua, 1);
  return stack;
}

DeclaredStack load_named_stack(lua_State* lua, const std::string& name) {
  Runtime& runtime = Runtime::of(lua);
  runtime.box->charge(kFileCost);
  std::vector<fs::path> hits;
  {
    const Sandbox::Pause pause(*runtime.box);
    hits = runtime.path.find_preset(name);
  }
  if (hits.empty()) {
    const auto names = runtime.path.preset_names();
    const std::string plain = name.ends_with(".lua") ? name.substr(0, name.size() - 4) : name;
    throw failure(fmt::format("there is no preset '{}'", tidy_message(name, 60)), {}, join(names),
                  std::ranges::count(names, plain) > 0 ? plain : nearest_name(plain, names));
  }
  // A preset may extend the one that it hides: those that are being loaded are passed over.
  const auto file = std::find_if(hits.begin(), hits.end(), [&](const fs::path& hit) {
    std::error_code ec;
    return !runtime.loading.contains("preset " + fs::weakly_canonical(hit, ec).string());
  });
  if (file == hits.end()) throw failure(fmt::format("preset '{}' extends itself", name));
  for (const auto& root : runtime.path.user)
    if (is_named_in(*file, root) && !lies_in(*file, root))
      throw failure(fmt::format("preset '{}' is a link that leads out of {}", name, root.string()));
  auto& user = runtime.path.user;
  for (const auto& folder : folders_of_preset(*file))
    if (std::find(user.begin(), user.end(), folder) == user.end()) user.push_back(folder);
  return load_stack(lua, *file);
}

bool is_identifier(const std::string& name) {
  if (name.empty() || name.size() > 64 || is_digit(name[0])) return false;
  return std::ranges::all_of(name, is_name_char);
}

void load_chunk(lua_State* lua, const fs::path& file, bool library, const std::optional<std::string>& given) {
  Runtime& runtime = Runtime::of(lua);
  Sandbox& box = *runtime.box;
  runtime.scripts.push_back(file);
  int index = 0;
  {
    const Sandbox::Pause pause(box);
    auto text = given ? Result<std::string>(*given) : read_named_file(file, kMaxScript, runtime.path.record.get());
    if (!text) {
      Error error = std::move(text).error();
      error.kind = ErrorKind::script;
      throw ScriptError{std::move(error)};
    }
    std::size_t bytes = text->size();
    for (const Source& source : box.sources()) bytes += source.text.size();
    if (bytes > kMaxScripts)
      throw ScriptError{{ErrorKind::script,
                         fmt::format("the scripts of this preset have more than {} MiB together", kMaxScripts >> 20),
                         file.string()}};
    index = box.add_source({file.string(), std::move(*text), library});
  }
  std::string_view text = box.sources()[static_cast<std::size_t>(index)].text;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  if (is_utf16(text)) throw ScriptError{{ErrorKind::script, kUtf16, file.string()}};
  if (text.starts_with('\x1B'))
    throw ScriptError{{ErrorKind::script, "is precompiled Lua; only text is allowed", file.string()}};
  const std::string chunk = fmt::format("=@{}", index);
  const int status = luaL_loadbufferx(lua, text.data(), text.size(), chunk.c_str(), "t");
  if (status == LUA_ERRMEM) {
    box.memory_failed();
    box.charge(0);
  }
  if (const Error* raised = status != LUA_OK ? box.raised(lua, -1) : nullptr)  // the parser's own recursion
    throw ScriptError{{ErrorKind::script, raised->message, file.string()}};
  if (status != LUA_OK) {
    Error error{ErrorKind::script, lua_tostring(lua, -1), file.string()};
    box.locate(error, box.take_prefix(error.message));
    name_symbol(error, text);
    name_missing(error, text);
    throw ScriptError{std::move(error)};
  }
  push_environment(lua);
  lua_setupvalue(lua, -2, 1);
}

void push_require(lua_State* lua) {
  lua_createtable(lua, 0, 4);
  push_library(lua);
  lua_setfield(lua, -2, kLibrary);
  lua_rawsetp(lua, LUA_REGISTRYINDEX, &kModules);
  lua_pushcfunction(lua, (&native<do_require, "require">));
}

std::vector<std::string> effect_names(const SearchPath& path, ScriptKind kind) {
  std::set<std::string> names;
  for (const auto& folder : path.script_folders(folder_of(kind))) {
    std::error_code ec;
    for (fs::directory_iterator it(folder, ec), end; !ec && it != end; it.increment(ec))
      if (it->path().extension() == ".lua" && is_identifier(it->path().stem().string()))
        names.insert(it->path().stem().string());
  }
  return {names.begin(), names.end()};
}

namespace {

/// What other languages call the library's types of settings, and masks, which are not written as effects are.
std::string elsewhere(const Runtime& runtime, const std::string& name) {
  static const std::map<std::string, std::string> kTypes{{"boolean", "bool"}, {"colour", "color"}, {"integer", "int"},
                                                         {"number", "float"}, {"string", "text"},  {"vec4", "vec3"}};
  if (const auto found = kTypes.find(name); found != kTypes.end()) return found->second;
  const auto masks = effect_names(runtime.path, ScriptKind::mask);
  return std::ranges::find(masks, name) == masks.end() ? "" : "mask." + name;
}

}  // namespace

int find_effect(lua_State* lua, const std::string& name, ScriptKind kind) {
  Runtime& runtime = Runtime::of(lua);
  const std::string folder = folder_of(kind), what = kind == ScriptKind::mask ? "mask" : "effect";
  const std::string known_as = kind == ScriptKind::mask ? "mask " + name : name;
  if (const auto it = runtime.effect_by_name.find(known_as); it != runtime.effect_by_name.end()) return it->second;
  std::vector<fs::path> hits;
  runtime.box->charge(kFileCost);
  if (is_identifier(name)) {
    const Sandbox::Pause pause(*runtime.box);
    for (const auto& hit : runtime.path.find_script(name, folder)) {
      std::error_code ec;
      const bool twice =
          std::any_of(hits.begin(), hits.end(), [&](const auto& other) { return fs::equivalent(hit, other, ec); });
      if (!twice) hits.push_back(hit);
    }
  }
  if (hits.empty()) {
    const auto effects = effect_names(runtime.path, kind);
    auto names = kind == ScriptKind::effect ? library_names() : std::vector<std::string>();
    names.insert(names.end(), effects.begin(), effects.end());
    std::string nearest = kind == ScriptKind::effect ? elsewhere(runtime, name) : "";
    if (nearest.empty()) nearest = nearest_name(name, names);
    const auto library = library_names();
    const bool of_library = std::ranges::find(library, nearest) != library.end();
    const std::string own = is_identifier(name)
                                ? fmt::format(", and {}/{}.lua beside the preset or below a --path", folder, name)
                                : std::string();
    throw failure(fmt::format("unknown {} '{}'", what, tidy_message(name, 60)), {},
                  of_library ? join(names) : "those that `afterglow effects` lists" + own, nearest);
  }
  // An installation may be made of links; what comes with a preset may not reach out of its folder.
  for (const auto& root : runtime.path.user)
    if (hits[0].parent_path() == root / folder && !lies_in(hits[0], root))
      throw failure(fmt::format("{} '{}' is a link that leads out of {}", what, name, root.string()));

  const Loading loading(runtime, folder + "." + name);
  const std::size_t made_before = runtime.effects.size();
  load_chunk(lua, hits[0]);
  call(lua, 0, 1);
  const Handle* made = to_object<Handle>(lua, -1, kEffectKind);
  const std::string file = hits[0].string();
  if (!made)
    throw not_returned(lua, hits[0], kind == ScriptKind::mask ? "a mask's file" : "an effect's file", "effect",
                       runtime.effects.size() > made_before);
  Effect& effect = runtime.effects[static_cast<std::size_t>(made->index)];
  if (effect.schema.name != name)
    throw ScriptError{
        {ErrorKind::script,
         fmt::format("declares the effect '{}', but its file is named '{}.lua'", effect.schema.name, name), file}};
  effect.schema.file = hits[0];
  effect.schema.shadowed.assign(hits.begin() + 1, hits.end());
  if (hits.size() > 1 && hits.back().parent_path() == runtime.path.installation / "scripts" / folder &&
      runtime.box->diagnostics)
    runtime.box->diagnostics->note(
        fmt::format("{} '{}' of {} shadows the built-in {}", what, name, file, hits.back().string()));
  runtime.effect_by_name[known_as] = made->index;
  const int index = made->index;
  lua_pop(lua, 1);
  return index;
}

}  // namespace afterglow::script
