// SPDX-License-Identifier: MIT
#include "script/sandbox.h"

#include <fmt/format.h>

#include <cstdlib>
#include <cstring>
#include <ctime>

#include "script/globals.h"

namespace afterglow::script {
namespace {

constexpr int kStep = 200;                     // instructions between two looks at the budget
constexpr int kShortStep = 4;                  // the same once there are texts that one instruction is long busy with
constexpr std::size_t kLongText = 256u << 10;  // bytes of such a text
constexpr int kMaxDepth = 10'000;              // nested calls
constexpr int kMostLevels = 300;               // that are looked through: lua_getstack counts from the top each time
constexpr std::size_t kLookEvery = 1u << 20;   // bytes allocated between two looks at the clock
constexpr std::uint64_t kRefusalCost = 1'000'000;  // a refused allocation costs a full collection

}  // namespace

Result<std::unique_ptr<Sandbox>> Sandbox::create(const ScriptLimits& limits) {
  std::unique_ptr<Sandbox> box(new Sandbox(limits));
  box->lua_ = lua_newstate(&allocate, box.get());
  if (!box->lua_) return Error{ErrorKind::script, fmt::format("memory limit of {} bytes is too small", limits.memory)};
  *static_cast<Sandbox**>(lua_getextraspace(box->lua_)) = box.get();
  if (auto error = box->run("", [](lua_State* lua) { open_globals(lua); })) return std::move(*error);
  return box;
}

Sandbox::~Sandbox() {
  if (lua_) lua_close(lua_);
}

// ---- limits

void* Sandbox::allocate(void* self, void* block, std::size_t old_size, std::size_t new_size) {
  auto& box = *static_cast<Sandbox*>(self);
  if (!block) {
    if (old_size == LUA_TSTRING && new_size > kLongText && box.step_ == kStep && !box.exhausted_)
      box.look_every(kShortStep);
    old_size = 0;  // Lua passes the type of the new object there
  }
  if (new_size == 0) {
    std::free(block);
    box.used_ -= old_size;
    return nullptr;
  }
  if (new_size > old_size) {
    if (box.used_ - old_size + new_size > box.limits_.memory) {
      box.instructions_ += kRefusalCost;
      if (box.lua_ && box.spent()) lua_sethook(box.lua_, &on_count, LUA_MASKCOUNT, 1);
      return nullptr;
    }
    box.allocated_ += new_size - old_size;
    if (box.allocated_ > kLookEvery) {  // string building is slow without many instructions
      box.instructions_ += box.allocated_ / 64;
      box.allocated_ = 0;
      if (box.lua_ && box.spent()) lua_sethook(box.lua_, &on_count, LUA_MASKCOUNT, 1);
    }
  }
  void* moved = std::realloc(block, new_size);
  if (!moved) return new_size <= old_size ? block : nullptr;  // Lua relies on shrinking never to fail
  box.used_ = box.used_ - old_size + new_size;
  return moved;
}

void Sandbox::arm() {
  exhausted_.reset();
  instructions_ = 0;
  allocated_ = 0;
  printed = 0;
  heavy_ = {};
  began_ = thread_seconds();
  deadline_ =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limits_.seconds));
  look_every(step_ == kShortStep ? kShortStep : kStep);  // long texts may have been kept
}

void Sandbox::look_every(int instructions) {
  step_ = instructions;
  lua_sethook(lua_, &on_count, LUA_MASKCOUNT, instructions);
}

double Sandbox::thread_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// On a busy machine a script waits for the processor: what counts is what the processor did for it. That clock is dear
// to read, so it is read when the cheap one says that the time may be up.
bool Sandbox::late() {
  const auto now = Clock::now();
  if (now <= deadline_) return false;
  const double left = limits_.seconds - (thread_seconds() - began_);
  if (left <= 0) return true;
  deadline_ = now + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(left));
  return false;
}

bool Sandbox::spent() { return exhausted_ || instructions_ > limits_.instructions || late() || interrupted(); }

Error Sandbox::spent_error() const {
  if (interrupted()) return {ErrorKind::interrupted, "the script was interrupted"};
  return {ErrorKind::script, fmt::format("instruction budget spent: more than {} instructions or {} s",
                                         limits_.instructions, limits_.seconds)};
}

void Sandbox::exhaust(Error error) {
  if (!exhausted_) exhausted_ = std::move(error);
  // From now on every single instruction raises again: pcall, <close> and metamethods cannot go on.
  lua_sethook(lua_, &on_count, LUA_MASKCOUNT, 1);
}

void Sandbox::on_count(lua_State* lua, lua_Debug* info) {
  Sandbox& box = of(lua);
  box.instructions_ += static_cast<std::uint64_t>(box.step_);
  const auto here = [&] {
    Location where;
    if (lua_getinfo(lua, "Sl", info)) where = box.location(info->source, info->currentline);
    if (where.source >= 0 && box.sources_[static_cast<std::size_t>(where.source)].library) where = box.caller(lua, 0);
    return where;
  };
  const auto place = [&](Error& error) { box.locate(error, here()); };
  if (!box.spent()) {
    // Where the memory ends Lua can no longer be asked for the line.
    if (box.used_ > box.limits_.memory / 2) box.heavy_ = here();
    // Lua's own limit lies beyond what the memory allows; this one tells what is wrong.
    lua_Debug deep{};
    if (!lua_getstack(lua, kMaxDepth, &deep)) return;
    Error error{ErrorKind::script, fmt::format("stack overflow: calls nest more than {} deep", kMaxDepth)};
    place(error);
    box.raise(std::move(error));
  }
  if (!box.exhausted_) {
    Error error = box.spent_error();
    place(error);
    box.exhaust(std::move(error));
  }
  box.raise(*box.exhausted_);
}

void Sandbox::charge(std::uint64_t instructions) {
  instructions_ += instructions;
  if (!spent()) return;
  if (exhausted_) raise(*exhausted_);
  Error error = spent_error();
  locate(error, caller(lua_));
  exhaust(error);
  raise(std::move(error));
}

void Sandbox::memory_failed() {
  Error error{ErrorKind::script,
              fmt::format("memory limit reached: more than {} MiB", static_cast<double>(limits_.memory) / 1048576.0)};
  locate(error, heavy_);
  exhaust(std::move(error));
}

// ---- errors

const void* Sandbox::keep(Error error) {
  errors_[++raised_ % errors_.size()] = std::move(error);
  return reinterpret_cast<const void*>(raised_);
}

Error* Sandbox::raised(lua_State* lua, int index) {
  if (!lua_islightuserdata(lua, index)) return nullptr;
  const auto id = reinterpret_cast<std::uintptr_t>(lua_touserdata(lua, index));
  if (id == 0 || id > raised_ || id + errors_.size() <= raised_) return nullptr;
  return &errors_[id % errors_.size()];
}

void Sandbox::raise(Error error) {
  error.message = tidy_message(std::move(error.message));
  error.allowed = tidy_message(std::move(error.allowed));
  const void* id = keep(std::move(error));
  lua_pushlightuserdata(lua_, const_cast<void*>(id));
  lua_error(lua_);
  std::abort();  // lua_error does not return
}

/// Of an error where the script is: the places in other scripts that called it, the nearest first, as far as what is
/// called is a function, not a file that is loaded.
void Sandbox::add_callers(lua_State* lua, Error& error) const {
  constexpr std::size_t kMostCallers = 3;
  if (!error.trail.empty()) return;
  std::optional<Location> inner;
  lua_Debug info{};
  for (int level = 0; level < kMostLevels && lua_getstack(lua, level, &info); ++level) {
    const auto where = place_in_script(lua, info);
    if (!where) continue;
    const std::string& path = sources_[static_cast<std::size_t>(where->source)].path;
    if (!inner && path != error.file) return;
    if (inner && where->source != inner->source)
      error.trail.push_back(fmt::format("called at {}:{}", path, where->line));
    if (error.trail.size() >= kMostCallers || std::string_view(info.what) == "main") return;
    inner = where;
  }
}

// The message handler: runs where the error was raised, so it knows the line. Must not itself raise.
int Sandbox::on_error(lua_State* lua) {
  Sandbox& box = of(lua);
  if (Error* const known = box.raised(lua, 1)) {
    box.add_callers(lua, *known);
    return 1;
  }
  Error error{ErrorKind::script, ""};
  Location where;
  if (lua_type(lua, 1) == LUA_TSTRING) {
    std::size_t size = 0;
    const char* text = lua_tolstring(lua, 1, &size);
    error.message.assign(text, std::min<std::size_t>(size, 2000));
    where = box.take_prefix(error.message);
  } else if (lua_type(lua, 1) == LUA_TNUMBER) {
    error.message = fmt::format("{}", lua_tonumber(lua, 1));
  } else {
    error.message = fmt::format("the script raised an error that is a {}, not a text", luaL_typename(lua, 1));
  }
  if (where.source < 0) where = box.caller(lua, 1);
  box.locate(error, where);
  box.add_callers(lua, error);
  error.message = tidy_message(std::move(error.message));
  const void* id = box.keep(std::move(error));
  lua_pushlightuserdata(lua, const_cast<void*>(id));
  return 1;
}

std::optional<Error> Sandbox::run_protected(const std::string& file, lua_CFunction call, void* work) {
  const int top = lua_gettop(lua_);
  arm();
  lua_pushcfunction(lua_, &on_error);
  lua_pushcfunction(lua_, call);
  lua_pushlightuserdata(lua_, work);
  const int status = lua_pcall(lua_, 1, 0, top + 1);
  lua_sethook(lua_, nullptr, 0, 0);
  std::optional<Error> error;
  if (status != LUA_OK || exhausted_) error = error_of(status, file);
  lua_settop(lua_, top);
  if (error) {
    // What a failed run left behind must not weigh on the next one; finalizers of scripts do not exist.
    exhausted_.reset();
    lua_gc(lua_, LUA_GCCOLLECT);
  }
  return error;
}

Error Sandbox::error_of(int status, const std::string& file) {
  if (status == LUA_ERRMEM && !exhausted_) memory_failed();
  Error error{ErrorKind::script, "too deep recursion in error handling"};
  if (exhausted_)
    error = *exhausted_;
  else if (const Error* known = raised(lua_, -1))
    error = *known;
  if (error.file.empty() && error.kind == ErrorKind::script) error.file = file;
  return error;
}

// ---- places

int Sandbox::add_source(Source source) {
  sources_.push_back(std::move(source));
  return static_cast<int>(sources_.size()) - 1;
}

Location Sandbox::location(const char* chunk_name, int line) const {
  // Chunks are named "=@INDEX": short, so that Lua never cuts it, whatever the path.
  if (std::strncmp(chunk_name, "=@", 2) != 0) return {};
  const int index = std::atoi(chunk_name + 2);
  if (index < 0 || index >= static_cast<int>(sources_.size())) return {};
  return {index, line};
}

/// Where a frame of the stack is; none of native functions and of the library.
std::optional<Location> Sandbox::place_in_script(lua_State* lua, lua_Debug& frame) const {
  if (!lua_getinfo(lua, "Sl", &frame) || frame.currentline <= 0) return std::nullopt;
  const Location where = location(frame.source, frame.currentline);
  if (where.source < 0 || sources_[static_cast<std::size_t>(where.source)].library) return std::nullopt;
  return where;
}

Location Sandbox::caller(lua_State* lua, int level) const {
  lua_Debug info{};
  // Frames between here and a script's are native or the library's, so few.
  for (const int last = level + kMostLevels; level < last && lua_getstack(lua, level, &info); ++level)
    if (const auto where = place_in_script(lua, info)) return *where;
  return {};
}

void Sandbox::locate(Error& error, const Location& where) const {
  if (where.source < 0) return;
  error.file = sources_[static_cast<std::size_t>(where.source)].path;
  error.line = where.line;
}

Location Sandbox::take_prefix(std::string& message) const {
  if (message.empty() || message[0] != '@') return {};
  char* end = nullptr;
  const long index = std::strtol(message.c_str() + 1, &end, 10);
  if (*end != ':' || index < 0 || index >= static_cast<long>(sources_.size())) return {};
  const long line = std::strtol(end + 1, &end, 10);
  if (*end != ':' || line <= 0) return {};
  const auto length = static_cast<std::size_t>(end + 1 - message.c_str());
  message.erase(0, length);
  if (!message.empty() && message[0] == ' ') message.erase(0, 1);
  return {static_cast<int>(index), static_cast<int>(line)};
}

}  // namespace afterglow::script
