// SPDX-License-Identifier: MIT
// The classes of the Python module.
#pragma once

#include <memory>
#include <mutex>
#include <optional>

#include "arrays.h"

namespace afterglow::python {

/// Raises the class of afterglow/__init__.py that fits the kind.
void raise(const Error& error);

class PyDevice {
 public:
  PyDevice(const std::string& device, bool validate, const std::optional<std::string>& cache, py::object message);
  const Device& get() const { return *device_; }
  py::object describe() const;

 private:
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

 private:
  template <class Work>
  auto alone(Work work) const;
  py::object get_plainly(const std::string& name) const;
  py::object json(std::string (Stack::*function)() const) const;

  std::shared_ptr<PyDevice> device_;
  std::unique_ptr<Stack> stack_;
  mutable std::mutex mutex_;
};

}  // namespace afterglow::python
