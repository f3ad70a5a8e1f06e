#include "apps/interrupt.h"

#include <csignal>

namespace afterglow {
namespace {

volatile std::sig_atomic_t g_interrupted = 0;  // the one global: signal handlers can reach nothing else

void on_signal(int) { g_interrupted = 1; }

}  // namespace

void install_interrupt_handler() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  std::signal(SIGXFSZ, SIG_IGN);  // a file beyond `ulimit -f` is a write that fails, with a message
}

bool interrupted() { return g_interrupted != 0; }

Error interrupt_error() { return Error{ErrorKind::interrupted, "interrupted"}; }

}  // namespace afterglow
