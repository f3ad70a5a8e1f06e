// SPDX-License-Identifier: MIT
// One sandboxed Lua 5.4 state: capped memory, a budget of instructions and time that no script can swallow,
// allow-listed globals, and errors that carry file and line. Knows nothing of presets and effects.
//
// Lua's C++ build is linked where there is one: its errors are C++ exceptions, so destructors of native frames run when
// one passes.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/diagnostics.h"
#include "core/exception.h"
#include "core/result.h"
#include "core/stopwatch.h"
#include "script/lua.h"
#include "script/preset.h"
#include "script/script_error.h"

namespace afterglow::script {

/// Text of a script that was read; chunk names refer to it by index, so that messages can give the whole path.
struct Source {
  std::string path;
  std::string text;
  bool library = false;  ///< a frame of the library is never the place of an error; its caller is
};

/// A place in a script.
struct Location {
  int source = -1;  ///< index in Sandbox::sources(); -1: none
  int line = 0;
};

/// Whom `error(message, 0)` in a function of an effect is about: the entry in the preset that asked for it.
struct Blame {
  std::string file;
  int line = 0;
  std::string function;  ///< of the call there; a message that begins with one of its keys points at that key
};

/// Not thread-safe; may move between threads.
class Sandbox {
 public:
  /// Errors (script): the memory limit is too small for a state.
  static Result<std::unique_ptr<Sandbox>> create(const ScriptLimits& limits);
  ~Sandbox();
  Sandbox(const Sandbox&) = delete;
  Sandbox& operator=(const Sandbox&) = delete;

  static Sandbox& of(lua_State* lua) { return **static_cast<Sandbox**>(lua_getextraspace(lua)); }
  lua_State* lua() { return lua_; }

  /// Runs `work(lua)` protected, with a fresh budget. Lua errors, ScriptErrors and exhausted limits come back as
  /// errors; `file` is named when no line is known. The stack is left as it was. Not to be nested.
  template <class Work>
  std::optional<Error> run(const std::string& file, Work&& work) {
    const lua_CFunction call = [](lua_State* lua) {
      auto& own = *static_cast<std::remove_reference_t<Work>*>(lua_touserdata(lua, 1));
      lua_settop(lua, 0);
      guard(lua, [&] { own(lua); });
      return 0;
    };
    return run_protected(file, call, &work);
  }

  /// Calls `work`; C++ exceptions become Lua errors, raised outside of the handler.
  template <class Work>
  static void guard(lua_State* lua, Work&& work) {
    std::optional<Error> error;
    try {
      work();
    } catch (ScriptError& e) {
      error = std::move(e.error);
    } catch (const std::exception& e) {
      error = exception_error(e);
    }
    if (error) of(lua).raise(std::move(*error));
  }

  /// Raises `error` as a Lua error; scripts that catch it see a string.
  [[noreturn]] void raise(Error error);
  /// The error behind a value that was raised; null when it is none of ours.
  Error* raised(lua_State* lua, int index);

  /// Counts work done natively as instructions; raises when the budget is spent.
  void charge(std::uint64_t instructions);
  /// pcall uses it: what was caught is not the script's to keep when a limit was reached.
  bool exhausted() const { return exhausted_.has_value(); }
  void memory_failed();

  /// Time that passes while one exists (reading files) does not count.
  class Pause {
   public:
    explicit Pause(Sandbox& box) : box_(box), begin_(Clock::now()), worked_(thread_seconds()) {}
    ~Pause() {
      box_.deadline_ += Clock::now() - begin_;
      box_.began_ += thread_seconds() - worked_;
    }

   private:
    Sandbox& box_;
    std::chrono::steady_clock::time_point begin_;
    double worked_;
  };

  int add_source(Source source);
  const std::vector<Source>& sources() const { return sources_; }
  /// The innermost place in a script (not in the library) at or above stack level `level`.
  Location caller(lua_State* lua, int level = 1) const;
  /// The place a chunk name and line of Lua's debug information mean.
  Location location(const char* chunk_name, int line) const;
  void locate(Error& error, const Location& where) const;
  /// Takes a "@3:17: " that Lua put before a message; `message` loses it.
  Location take_prefix(std::string& message) const;

  std::size_t memory_used() const { return used_; }
  /// A script is about to ask for so many bytes at once: where, for the message if there is no room for them.
  void will_hold(lua_State* lua, std::uint64_t bytes) {
    if (bytes > limits_.memory / 2) heavy_ = caller(lua);
  }
  /// Messages of `print`; null: dropped.
  Diagnostics* diagnostics = nullptr;
  const Blame* blame = nullptr;
  int printed = 0;        ///< lines since the run began
  void* owner = nullptr;  ///< whoever binds more functions

 private:
  explicit Sandbox(const ScriptLimits& limits) : limits_(limits) {}
  std::optional<Error> run_protected(const std::string& file, lua_CFunction call, void* work);
  static double thread_seconds();  // what the processor has spent on this thread
  void arm();
  void look_every(int instructions);
  bool late();
  bool spent();
  bool interrupted() const {
    return limits_.until && Clock::now().time_since_epoch().count() >= limits_.until->load(std::memory_order_relaxed);
  }
  Error spent_error() const;
  void exhaust(Error error);
  Error error_of(int status, const std::string& file);
  const void* keep(Error error);
  static void* allocate(void* self, void* block, std::size_t old_size, std::size_t new_size);
  static void on_count(lua_State* lua, lua_Debug* info);
  std::optional<Location> place_in_script(lua_State* lua, lua_Debug& frame) const;
  static int on_error(lua_State* lua);
  void add_callers(lua_State* lua, Error& error) const;

  ScriptLimits limits_;
  lua_State* lua_ = nullptr;
  std::size_t used_ = 0;
  std::size_t allocated_ = 0;       // since the clock was last looked at
  std::uint64_t instructions_ = 0;  // since arm()
  int step_ = 0;                    // instructions between two looks at the budget
  Clock::time_point deadline_;      // before it, no script is late
  double began_ = 0;                // thread_seconds() at arm(), pauses left out
  Location heavy_;                  // where a script was when it was last seen to hold more than half of the memory
  std::optional<Error> exhausted_;  // sticky until the next arm()
  std::vector<Source> sources_;
  // Raised errors live here and not in Lua, so that raising one needs no Lua memory; few are alive at a time.
  std::array<Error, 64> errors_;
  std::uintptr_t raised_ = 0;
};

}  // namespace afterglow::script
