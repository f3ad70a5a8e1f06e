// SPDX-License-Identifier: MIT
// Functions of Python's that the library calls.
#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <memory>

#include "afterglow.hpp"

namespace afterglow::python {

namespace py = pybind11;

/// One function, called on whatever thread. The object that it was given to shows it to Python's garbage collector, by
/// `visit` and `clear`: often it is a method of what owns that object. Needs the interpreter's lock for all but
/// `is_running`.
class Callback {
 public:
  explicit Callback(py::object function) : function_(std::move(function)) {}

  bool is_none() const { return function_ && function_.is_none(); }
  /// Calls `work(function)`, unless it was cleared. `name` is what Python says of exceptions, which end here.
  void call(const char* name, const std::function<void(const py::object&)>& work) const;
  /// It is being called on this very thread.
  bool is_running() const;

  int visit(visitproc visit, void* arg) const;
  void clear();

 private:
  py::object function_;
};

/// May be let go without the interpreter's lock.
std::shared_ptr<Callback> callback_of(const py::object& function);

/// Calls it, or logs to the logger "afterglow" where it is None.
MessageSink sink_of(std::shared_ptr<Callback> message);

/// Empty where it is None.
std::function<void()> wake_of(std::shared_ptr<Callback> wake);

}  // namespace afterglow::python
