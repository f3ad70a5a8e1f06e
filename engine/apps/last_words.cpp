#include "apps/last_words.h"

#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>

#include "core/result.h"

namespace afterglow {
namespace {

void say(const char* text) {
  // Nothing is left to be done about a message that cannot be written.
  if (write(STDERR_FILENO, text, std::strlen(text)) < 0) return;
}

/// Takes no memory: there may be none.
[[noreturn]] void on_terminate() {
  try {
    if (const auto exception = std::current_exception()) std::rethrow_exception(exception);
    say("error: internal error\n");
  } catch (const std::bad_alloc&) {
    say("error: out of memory\n");
    std::_Exit(static_cast<int>(ErrorKind::io));
  } catch (const std::exception& exception) {
    say("error: internal error: ");
    say(exception.what());
    say("\n");
  } catch (...) {
    say("error: internal error\n");
  }
  std::_Exit(static_cast<int>(ErrorKind::other));
}

}  // namespace

void install_last_words() { std::set_terminate(on_terminate); }

}  // namespace afterglow
