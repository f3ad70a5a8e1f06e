// SPDX-License-Identifier: MIT
#include "image/oiio_compare.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>

namespace afterglow {
namespace {

constexpr float kLuminance = 100;   ///< cd/m² of white
constexpr float kFieldOfView = 45;  ///< degrees that the picture's width takes

/// On the pixels of `image`, which it does not change.
OIIO::ImageBuf view_of(const Image& image) {
  const OIIO::ImageSpec spec(image.width, image.height, image.channels, OIIO::TypeDesc::FLOAT);
  return OIIO::ImageBuf(spec, const_cast<float*>(image.pixels.data()));
}

}  // namespace

Result<double> visible_difference_with_oiio(const Image& a, const Image& b) {
  const OIIO::ImageBuf first = view_of(a), second = view_of(b);
  OIIO::ImageBufAlgo::CompareResults found{};
  const int different = OIIO::ImageBufAlgo::compare_Yee(first, second, found, kLuminance, kFieldOfView);
  if (first.has_error()) return Error{ErrorKind::other, "pictures cannot be compared: " + first.geterror()};
  return std::max(0, different) / std::max(1.0, static_cast<double>(a.size().area()));
}

}  // namespace afterglow
