// SPDX-License-Identifier: MIT
// Python's garbage collector and the classes of the module.
#pragma once

#include <pybind11/pybind11.h>

#include <string>

namespace afterglow::python {

namespace py = pybind11;

/// The object in `self`; null where its constructor has not ended: the collector may run earlier.
template <class T>
T* made(PyObject* self) {
  auto* instance = reinterpret_cast<py::detail::instance*>(self);
  if (!instance->owned) return nullptr;
  auto place = instance->get_value_and_holder(py::detail::get_type_info(typeid(T)), false);
  return place.inst && place.holder_constructed() ? place.template value_ptr<T>() : nullptr;
}

/// Of T as an argument. Refuses objects whose __init__ has not run: pybind11 hands out memory that nobody has filled.
template <class T>
struct MadeCaster : py::detail::type_caster_base<T> {
  bool load(py::handle source, bool convert) {
    if (py::isinstance<T>(source) && !made<T>(source.ptr()))
      throw py::type_error(py::type::of(source).attr("__name__").template cast<std::string>() +
                           ".__init__() has not been called");
    return py::detail::type_caster_base<T>::load(source, convert);
  }
};

/// For a class_ of T, which has `int visit(visitproc, void*) const` over the Python objects that it holds, each once,
/// and `void clear()` that lets go of them.
template <class T>
py::custom_type_setup collected() {
  return py::custom_type_setup([](PyHeapTypeObject* made_type) {
    PyTypeObject& type = made_type->ht_type;
    type.tp_flags |= Py_TPFLAGS_HAVE_GC;
    type.tp_traverse = [](PyObject* self, visitproc visit, void* arg) -> int {
#if PY_VERSION_HEX >= 0x03090000
      Py_VISIT(Py_TYPE(self));
#endif
      const T* object = made<T>(self);
      return object ? object->visit(visit, arg) : 0;
    };
    type.tp_clear = [](PyObject* self) -> int {
      if (T* object = made<T>(self)) object->clear();
      return 0;
    };
    // Not all versions of pybind11 take the object from the collector before it goes.
    type.tp_dealloc = [](PyObject* self) {
      PyObject_GC_UnTrack(self);
      py::detail::pybind11_object_dealloc(self);
    };
  });
}

}  // namespace afterglow::python
