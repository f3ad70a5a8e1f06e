// SPDX-License-Identifier: MIT
// Arrays of numpy as pictures of afterglow.h.
#pragma once

#include <pybind11/numpy.h>

#include <vector>

#include "afterglow.hpp"

namespace afterglow::python {

namespace py = pybind11;

/// An array that is kept as long as its picture is used.
struct Picture {
  py::array array;
  afterglow_image image{};
};

/// (height, width, channels) or, with one channel, (height, width); float32, float16 or uint8. Other floats
/// become float32, and so do whole numbers of images that `may_be_flat`, which are no colours; layouts that the library
/// cannot read are copied. Throws py::value_error.
Picture input(const py::object& given, const char* name, bool may_be_flat);

/// `given` to be written in place: float32, float16 or uint8, writeable, each pixel in a place of its
/// own. Throws py::value_error.
Picture output(const py::object& given);

/// Copies of those sources that `result` would overwrite while they are read. The first, the colours, may be the result
/// itself.
void keep_apart(std::vector<Picture>& sources, const Picture& result);

/// A new array for the result of `source`: like it, or of the type that is wanted.
Picture output_like(const Picture& source, const py::object& dtype);

}  // namespace afterglow::python
