// SPDX-License-Identifier: MIT
// The classes of the Python module.
#pragma once

#include <unistd.h>

#include <memory>
#include <mutex>
#include <optional>

#include "arrays.h"
#include "callback.h"
#include "collect.h"

namespace afterglow::python {

class PyDevice {
 public:
  PyDevice(const std::string& device, bool validate, const py::object& cache, const py::object& message);
  /// Kept by whoever uses it while it may be closed. Throws py::value_error.
  std::shared_ptr<Device> get() const;
  const std::shared_ptr<Callback>& message() const { return message_; }
  py::object describe() const;
  /// Stacks that were made on it go on.
  void close();

  int visit(visitproc visit, void* arg) const { return message_->visit(visit, arg); }
  void clear() { message_->clear(); }

 private:
  std::shared_ptr<Callback> message_;
  std::shared_ptr<Device> device_;
};

/// Calls from several threads wait for each other.
class PyStack {
 public:
  PyStack(const py::object& preset, const py::kwargs& options);
  ~PyStack();
  PyStack(const PyStack&) = delete;

  py::array run(const py::object& source, const py::kwargs& options);
  void set(const std::string& name, const py::object& value);
  void set_several(const py::dict& values);
  void unset(const std::optional<std::string>& name);
  void set_argument(const std::string& name, const py::object& value);
  py::object get(const std::string& name) const;
  py::object settings() const;
  py::object arguments() const;
  py::object explain() const;
  py::object report() const;
  void reload(const std::optional<std::string>& text);
  bool update();
  void reset_history();
  void close();

  int visit(visitproc visit, void* arg) const;
  void clear();

 private:
  bool in_own_function() const;
  std::unique_lock<std::mutex> wait_for_others() const;
  template <class Work>
  auto alone(Work work) const;
  py::object get_plainly(const std::string& name) const;
  py::object json(std::string (Stack::*function)() const) const;

  py::object device_;  // the PyDevice, as Python has it: the collector has to see the way to it
  std::shared_ptr<Callback> message_, wake_, device_message_;
  std::unique_ptr<Stack> stack_;
  pid_t process_ = getpid();
  mutable std::mutex mutex_;
};

}  // namespace afterglow::python

template <>
struct pybind11::detail::type_caster<afterglow::python::PyDevice>
    : afterglow::python::MadeCaster<afterglow::python::PyDevice> {};
template <>
struct pybind11::detail::type_caster<afterglow::python::PyStack>
    : afterglow::python::MadeCaster<afterglow::python::PyStack> {};
