// SPDX-License-Identifier: MIT
#include "apps/terminate_handler.h"

#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>

#include "core/result.h"
#include "core/temporary.h"

namespace afterglow {
namespace {

void say(const char* text) {
  // Nothing is left to be done about a message that cannot be written.
  if (write(STDERR_FILENO, text, std::strlen(text)) < 0) return;
}

thread_local bool t_no_memory = false;

void on_no_memory() {
  t_no_memory = true;
  throw std::bad_alloc();
}

/// Nothing is taken apart, but no half-written file stays.
[[noreturn]] void end_at_once(ErrorKind kind) {
  remove_own_temporaries();
  std::_Exit(static_cast<int>(kind));
}

[[noreturn]] void end_without_memory() {
  say("error: out of memory\n");
  end_at_once(ErrorKind::io);
}

/// Takes no memory: there may be none.
[[noreturn]] void on_terminate() {
  try {
    if (const auto exception = std::current_exception()) std::rethrow_exception(exception);
    // Functions that are compiled not to throw end the process before an exception counts as caught.
    if (t_no_memory) end_without_memory();
    say("error: internal error\n");
  } catch (const std::bad_alloc&) {
    end_without_memory();
  } catch (const std::exception& exception) {
    say("error: internal error: ");
    say(exception.what());
    say("\n");
  } catch (...) {
    say("error: internal error\n");
  }
  end_at_once(ErrorKind::other);
}

}  // namespace

void install_last_words() {
  std::set_new_handler(on_no_memory);
  std::set_terminate(on_terminate);
}

}  // namespace afterglow
