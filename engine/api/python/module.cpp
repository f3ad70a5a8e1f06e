// SPDX-License-Identifier: MIT
// The Python module: afterglow.hpp with arrays of numpy. What users read stands in __init__.pyi.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "collect.h"
#include "stack.h"

namespace py = pybind11;
using afterglow::python::collected;
using afterglow::python::PyDevice;
using afterglow::python::PyStack;

namespace {

/// Without the name of a function or structure of the C interface before it.
std::string plain(std::string message) {
  const std::size_t begin = message.starts_with("error: ") ? 7 : 0, end = message.find(": ", begin);
  if (message.compare(begin, 10, "afterglow_") == 0 && end != std::string::npos) message.erase(begin, end + 2 - begin);
  return message;
}

/// Raises the class of afterglow/__init__.py that fits the kind.
void raise(const afterglow::Error& error) {
  const py::module_ module = py::module_::import("afterglow");
  const char* name = error.kind == AFTERGLOW_ERROR_USAGE    ? "UsageError"
                     : error.kind == AFTERGLOW_ERROR_SCRIPT ? "ScriptError"
                     : error.kind == AFTERGLOW_ERROR_IO     ? "FileError"
                     : error.kind == AFTERGLOW_ERROR_DEVICE ? "DeviceError"
                                                            : "Error";
  const py::object type = module.attr(name);
  const auto or_none = [](const std::string& text) { return text.empty() ? py::object(py::none()) : py::str(text); };
  const py::object raised = type(plain(error.what()), plain(error.message), or_none(error.file),
                                 error.line > 0 ? py::object(py::int_(error.line)) : py::none(), or_none(error.allowed),
                                 or_none(error.nearest));
  PyErr_SetObject(type.ptr(), raised.ptr());
}

py::object itself(py::object self) { return self; }

template <class T>
void leave(T& self, const py::args&) {
  self.close();
}

}  // namespace

PYBIND11_MODULE(_afterglow, module) {
  module.attr("__version__") = std::to_string(AFTERGLOW_VERSION_MAJOR) + "." + std::to_string(AFTERGLOW_VERSION_MINOR) +
                               "." + std::to_string(AFTERGLOW_VERSION_PATCH);

  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const afterglow::Error& error) {
      raise(error);
    }
  });

  py::class_<PyDevice, std::shared_ptr<PyDevice>>(module, "Device", "A Vulkan device.", collected<PyDevice>())
      .def(py::init<const std::string&, bool, const py::object&, const py::object&>(), py::arg("device") = "auto",
           py::kw_only(), py::arg("validate") = false, py::arg("cache") = py::none(), py::arg("message") = py::none())
      .def("describe", &PyDevice::describe, "Name, type, driver, uuid and what the validation layer has said.")
      .def("close", &PyDevice::close, "Lets go of the device; its stacks go on.")
      .def("__enter__", &itself)
      .def("__exit__", &leave<PyDevice>);

  py::class_<PyStack>(module, "Stack", "A preset made runnable on a device.", collected<PyStack>())
      .def(py::init<const py::object&, const py::kwargs&>(), py::arg("preset") = py::none())
      .def("run", &PyStack::run, py::arg("source"), "Runs the stack on a picture; returns the result.")
      .def("set", &PyStack::set, py::arg("name"), py::arg("value"), "Sets ENTRY.SETTING.")
      .def("set", &PyStack::set_several, py::arg("values"), "Sets several at once, all or none.")
      .def("unset", &PyStack::unset, py::arg("name") = py::none(), "Back to what the preset says.")
      .def("set_argument", &PyStack::set_argument, py::arg("name"), py::arg("value"),
           "Gives an argument of the preset a value; None: its default.")
      .def("get", &PyStack::get, py::arg("name"), "The value of ENTRY.SETTING in the last frame.")
      .def_property_readonly("settings", &PyStack::settings, "Entries with their settings.")
      .def_property_readonly("arguments", &PyStack::arguments, "What the preset declares by fx.args.")
      .def("explain", &PyStack::explain, "How the settings of the last frame came about.")
      .def("report", &PyStack::report, "What ran in the last frame, what did not and why, times.")
      .def("reload", &PyStack::reload, py::arg("text") = py::none(), "Reads the files again, or takes another text.")
      .def("update", &PyStack::update, "With follow=True: takes edits; true when there were any.")
      .def("reset_history", &PyStack::reset_history, "Forgets earlier frames.")
      .def("close", &PyStack::close, "Frees what it holds, and ends its threads.")
      .def("__enter__", &itself)
      .def("__exit__", &leave<PyStack>);
}
