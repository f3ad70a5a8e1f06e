// SPDX-License-Identifier: MIT
#include "callback.h"

#include <string>
#include <utility>

namespace afterglow::python {
namespace {

/// What runs on this thread, the innermost first: a message function may use another stack, which has its own.
class Running {
 public:
  explicit Running(const Callback* callback) : callback_(callback), outer_(innermost_) { innermost_ = this; }
  ~Running() { innermost_ = outer_; }
  Running(const Running&) = delete;
  static bool has(const Callback* callback) {
    for (const Running* one = innermost_; one; one = one->outer_)
      if (one->callback_ == callback) return true;
    return false;
  }

 private:
  static thread_local const Running* innermost_;
  const Callback* callback_;
  const Running* outer_;
};
thread_local const Running* Running::innermost_ = nullptr;

}  // namespace

void Callback::call(const char* name, const std::function<void(const py::object&)>& work) const {
  const Running here(this);               // until all is gone that the call held: it may be the last of the stack
  const py::object function = function_;  // stays while it runs, also when it is cleared meanwhile
  if (!function) return;
  try {
    work(function);
  } catch (py::error_already_set& error) {
    // Ctrl+C is meant for the program, whichever function it came to: the main thread raises it once more.
    const bool interrupted = error.matches(PyExc_KeyboardInterrupt);
    error.discard_as_unraisable(name);
    if (interrupted) PyErr_SetInterrupt();
  }
}

bool Callback::is_running() const { return Running::has(this); }

int Callback::visit(visitproc visit, void* arg) const {
  Py_VISIT(function_.ptr());
  return 0;
}

void Callback::clear() { const py::object gone = std::exchange(function_, py::object()); }

std::shared_ptr<Callback> callback_of(const py::object& function) {
  return {new Callback(function), [](Callback* callback) {
            const py::gil_scoped_acquire lock;
            delete callback;
          }};
}

MessageSink sink_of(std::shared_ptr<Callback> message) {
  return [message = std::move(message)](afterglow_severity severity, std::string_view text) {
    const py::gil_scoped_acquire lock;
    const char* level = severity == AFTERGLOW_WARNING ? "warning" : "info";
    message->call("afterglow's message function", [&](const py::object& function) {
      if (function.is_none())
        py::module_::import("logging").attr("getLogger")("afterglow").attr(level)("%s", std::string(text));
      else
        function(level, std::string(text));
    });
  };
}

std::function<void()> wake_of(std::shared_ptr<Callback> wake) {
  if (wake->is_none()) return {};
  return [wake = std::move(wake)] {
    const py::gil_scoped_acquire lock;
    wake->call("afterglow's wake function", [](const py::object& function) { function(); });
  };
}

}  // namespace afterglow::python
