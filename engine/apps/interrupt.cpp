// SPDX-License-Identifier: MIT
#include "apps/interrupt.h"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstring>

#include "core/patience.h"
#include "core/temporary.h"

namespace afterglow {
namespace {

// Globals: signal handlers can reach nothing else. Atomic: a signal comes on any thread.
std::atomic<bool> g_interrupted = false;
std::atomic<unsigned> g_grace = 1;  // seconds between being asked to stop and being stopped
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<unsigned>::is_always_lock_free);

/// A driver may compile or draw for minutes and hears nothing meanwhile. What is half-written goes.
[[noreturn]] void end_at_once(int) {
  remove_own_temporaries();
  constexpr const char* kMessage = "error: interrupted\n";
  const ssize_t written = write(STDERR_FILENO, kMessage, std::strlen(kMessage));
  static_cast<void>(written);
  _exit(static_cast<int>(ErrorKind::interrupted));
}

void on_signal(int signal) {
  if (g_interrupted.exchange(true)) {
    if (signal == SIGXCPU) return;  // comes again each second
    end_at_once(signal);
  }
  give_up_waiting();
  alarm(g_grace);
}

void handle(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
}

/// What nohup and shells have said is to be ignored (`trap '' INT`) stays so.
void handle_unless_ignored(int signal) {
  struct sigaction now {};
  if (sigaction(signal, nullptr, &now) != 0 || now.sa_handler != SIG_IGN) handle(signal, on_signal);
}

}  // namespace

void install_interrupt_handler() {
  handle(SIGALRM, end_at_once);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGXCPU}) handle_unless_ignored(signal);
  std::signal(SIGXFSZ, SIG_IGN);  // a file beyond `ulimit -f` is a write that fails, with a message
  std::signal(SIGPIPE, SIG_IGN);  // so is one into a pipe that nobody reads
}

void allow_to_end(unsigned seconds) { g_grace = seconds; }

bool interrupted() { return g_interrupted; }

Error interrupt_error() { return Error{ErrorKind::interrupted, "interrupted"}; }

}  // namespace afterglow
