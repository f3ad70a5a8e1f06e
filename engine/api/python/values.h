// SPDX-License-Identifier: MIT
// Values of Python's as the library takes them.
#pragma once

#include <pybind11/stl.h>

#include <set>
#include <string>
#include <type_traits>
#include <vector>

namespace afterglow::python {

namespace py = pybind11;

/// Raises afterglow.UsageError, which is a ValueError too.
[[noreturn]] void refuse(const std::string& message);

/// Arrays and scalars of numpy that are one value, as that; others as they are.
py::object plain(const py::object& value);

/// What Python calls a wrong type, it does: pybind11 makes a RuntimeError of it.
template <class T>
T cast(const py::object& value, const std::string& name, const char* what) {
  try {
    return value.cast<T>();
  } catch (const py::cast_error&) {
    throw py::type_error(name + " must be " + what + ", not " +
                         py::type::of(value).attr("__name__").cast<std::string>());
  }
}
template <class T>
constexpr const char* kWhat = std::is_same_v<T, bool>   ? "a bool"
                              : std::is_unsigned_v<T>   ? "a whole number from 0 on"
                              : std::is_arithmetic_v<T> ? "a number"
                                                        : "a str";

bool is_bool(const py::handle& value);
bool is_number(const py::handle& value);

/// As UTF-8. Parts of it that name files in other bytes (surrogates, as os.listdir gives them) become those bytes.
std::string text_of(const py::handle& text);

/// str, bytes or os.PathLike, as the bytes that the system knows a file by.
std::string path_text(const py::handle& path);

/// One path or some.
std::vector<std::string> path_texts(const py::object& paths);

/// The value of a setting or an argument as the command line writes it.
std::string value_text(const std::string& name, const py::handle& value);

/// Options by name, each asked for once; what nobody asked for is unknown.
class Options {
 public:
  Options(const char* function, const py::kwargs& given) : function_(function), given_(given) {}

  py::object take(const char* name);
  template <class T>
  T take(const char* name, T otherwise) {
    const py::object value = take(name);
    return value.is_none() ? otherwise : cast<T>(value, name, kWhat<T>);
  }
  void finish() const;

 private:
  const char* function_;
  const py::kwargs& given_;
  std::set<std::string> known_;
};

}  // namespace afterglow::python
