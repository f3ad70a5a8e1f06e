// SPDX-License-Identifier: MIT
#include "arrays.h"

#include <algorithm>
#include <cstdlib>
#include <string>

namespace afterglow::python {
namespace {

bool is_half(const py::dtype& type) { return type.kind() == 'f' && type.itemsize() == 2; }
bool is_float(const py::dtype& type) { return type.kind() == 'f' && type.itemsize() == 4; }
bool is_codes(const py::dtype& type) { return type.kind() == 'u' && type.itemsize() == 1; }
bool is_native(const py::dtype& type) { return type.byteorder() == '=' || type.byteorder() == '|'; }
/// Numbers that may be light. Whole ones may be codes of any kind, but for bytes, which say it.
bool may_be_light(const py::dtype& type) { return type.kind() == 'f' || is_codes(type); }
bool is_number(const py::dtype& type) { return may_be_light(type) || type.kind() == 'u' || type.kind() == 'i'; }
bool is_known(const py::dtype& type) { return is_native(type) && (is_half(type) || is_float(type) || is_codes(type)); }

std::string shape_text(const py::array& array) { return py::str(array.attr("shape")).cast<std::string>(); }

/// Channels lie next to each other, pixels go to the right without touching, and so do rows, up or down: what the
/// library reads. Not so are views that show one sample at many places, such as those of numpy.broadcast_to.
bool is_readable(const py::array& array) {
  const auto channels = array.ndim() == 3 ? array.shape(2) : 1;
  const auto item = array.itemsize();
  const auto pixel = channels * item, width = array.shape(1);
  if (channels > 1 && array.strides(2) != item) return false;
  if (width > 1 && array.strides(1) < pixel) return false;
  const auto row = pixel + (width > 1 ? array.strides(1) * (width - 1) : 0);
  return array.shape(0) <= 1 || std::abs(array.strides(0)) >= row;
}

/// Before anything is copied: views of one sample may be of any size.
void check_shape(const py::array& array, const char* name) {
  if (array.ndim() < 2 || array.ndim() > 3 || (array.ndim() == 3 && array.shape(2) > 4))
    refuse(std::string(name) + ": the shape is " + shape_text(array) +
           "; allowed: (height, width, channels), with channels next to each other, 4 at most");
  if (std::max(array.shape(0), array.shape(1)) > AFTERGLOW_LARGEST_SIDE)
    refuse(std::string(name) + ": the shape is " + shape_text(array) + "; sides go from 1 to " +
           std::to_string(AFTERGLOW_LARGEST_SIDE));
}

/// What is below the mask would count.
void refuse_mask(const py::handle& array, const char* name) {
  if (!py::isinstance(array, py::module_::import("numpy.ma").attr("MaskedArray"))) return;
  const std::string text(name);
  throw py::type_error(text + " is a masked array; give its values: " + text + ".filled(0), or " + text + ".data");
}

afterglow_image image_of(py::array& array, const char* name) {
  check_shape(array, name);
  afterglow_image image{};
  image.data = const_cast<void*>(array.data());
  image.height = static_cast<std::int32_t>(array.shape(0));
  image.width = static_cast<std::int32_t>(array.shape(1));
  image.channels = array.ndim() == 3 ? static_cast<std::int32_t>(array.shape(2)) : 1;
  image.row_stride = array.strides(0);
  image.pixel_stride = array.shape(1) == 1 ? 0 : array.strides(1);
  image.samples = is_half(array.dtype()) ? AFTERGLOW_HALF : is_codes(array.dtype()) ? AFTERGLOW_UINT8 : AFTERGLOW_FLOAT;
  if (array.shape(0) == 1) image.row_stride = 0;
  return image;
}

}  // namespace

Picture input(const py::object& given, const char* name, bool may_be_flat) {
  refuse_mask(given, name);
  py::array array = py::module_::import("numpy").attr("asarray")(given);
  if (array.dtype().kind() == 'O') refuse(std::string(name) + " is no array of numbers");
  if (may_be_flat ? !is_number(array.dtype()) : !may_be_light(array.dtype()))
    refuse(std::string(name) + " is an array of " + py::str(array.dtype()).cast<std::string>() +
           (may_be_flat ? "; allowed: numbers"
                        : "; allowed: floats, which are scene-linear light, and uint8, which are sRGB codes"));
  check_shape(array, name);
  if (!is_known(array.dtype())) array = array.attr("astype")("float32");
  if (array.ndim() == 2 && !may_be_flat)
    refuse(std::string(name) + ": the shape is " + shape_text(array) +
           "; allowed: (height, width, 3) or (height, width, 4)");
  if (!is_readable(array)) array = py::module_::import("numpy").attr("ascontiguousarray")(array);
  Picture out{array, {}};
  out.image = image_of(out.array, name);
  return out;
}

void keep_apart(std::vector<Picture>& sources, const Picture& result) {
  const py::module_ numpy = py::module_::import("numpy");
  for (Picture& source : sources) {
    const bool same = &source == sources.data() && source.image.data == result.image.data &&
                      source.image.samples == result.image.samples &&
                      source.image.row_stride == result.image.row_stride &&
                      source.image.pixel_stride == result.image.pixel_stride;
    if (same || !numpy.attr("may_share_memory")(source.array, result.array).cast<bool>()) continue;
    source.array = source.array.attr("copy")();
    source.image = image_of(source.array, "source");
  }
}

Picture output(const py::object& given) {
  if (!py::isinstance<py::array>(given)) refuse("out is no numpy array");
  refuse_mask(given, "out");
  auto array = py::reinterpret_borrow<py::array>(given);
  if (!array.writeable()) refuse("out is read-only");
  if (!is_known(array.dtype())) refuse("out must be of float32, float16 or uint8");
  if (array.ndim() != 3 || !is_readable(array))
    refuse(
        "out must be (height, width, channels), with channels next to each other, and no two "
        "pixels in one place");
  Picture out{array, {}};
  out.image = image_of(out.array, "out");
  return out;
}

Picture output_like(const Picture& source, const py::object& dtype) {
  const py::dtype type = dtype.is_none() ? source.array.dtype() : py::dtype::from_args(dtype);
  if (!is_known(type)) refuse("dtype must be float32, float16 or uint8");
  py::array array = py::module_::import("numpy").attr("empty")(source.array.attr("shape"), type);
  Picture out{array, {}};
  out.image = image_of(out.array, "out");
  return out;
}

}  // namespace afterglow::python
