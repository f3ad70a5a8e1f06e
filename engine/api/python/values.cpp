// SPDX-License-Identifier: MIT
#include "values.h"

namespace afterglow::python {

void refuse(const std::string& message) {
  PyErr_SetString(py::module_::import("afterglow").attr("UsageError").ptr(), message.c_str());
  throw py::error_already_set();
}

py::object plain(const py::object& value) {
  const bool one = py::hasattr(value, "item") && py::getattr(value, "ndim", py::none()).equal(py::int_(0));
  return one ? value.attr("item")() : value;
}

bool is_bool(const py::handle& value) { return py::isinstance<py::bool_>(value); }

bool is_number(const py::handle& value) { return PyNumber_Check(value.ptr()) && !PySequence_Check(value.ptr()); }

std::string text_of(const py::handle& text) {
  return text.attr("encode")("utf-8", "surrogateescape").cast<std::string>();
}

std::string path_text(const py::handle& path) {
  return py::module_::import("os").attr("fsencode")(path).cast<std::string>();
}

std::vector<std::string> path_texts(const py::object& paths) {
  if (py::isinstance<py::str>(paths) || py::isinstance<py::bytes>(paths) || py::hasattr(paths, "__fspath__"))
    return {path_text(paths)};
  std::vector<std::string> out;
  for (const auto& path : paths) out.push_back(path_text(path));
  return out;
}

std::string value_text(const std::string& name, const py::handle& given) {
  const py::object value = plain(py::reinterpret_borrow<py::object>(given));
  if (py::isinstance<py::str>(value)) return text_of(value);
  if (is_bool(value)) return value.cast<bool>() ? "true" : "false";
  if (py::isinstance<py::int_>(value)) return py::str(value).cast<std::string>();
  if (is_number(value)) return py::repr(py::float_(value)).cast<std::string>();
  const auto numbers = cast<std::vector<double>>(value, name, "a bool, a number, a str or some numbers");
  std::string text;
  for (const double number : numbers)
    text += (text.empty() ? "" : ", ") + py::repr(py::float_(number)).cast<std::string>();
  return numbers.size() == 1 ? text : "{" + text + "}";
}

py::object Options::take(const char* name) {
  known_.insert(name);
  return given_.contains(name) ? py::object(given_[name]) : py::none();
}

void Options::finish() const {
  for (const auto& [key, value] : given_)
    if (!known_.count(key.cast<std::string>()))
      throw py::type_error(std::string(function_) + "() got an unexpected keyword argument '" +
                           key.cast<std::string>() + "'");
}

}  // namespace afterglow::python
