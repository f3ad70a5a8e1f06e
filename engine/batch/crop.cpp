// SPDX-License-Identifier: MIT
#include "batch/crop.h"

#include <fmt/format.h>

#include <algorithm>

namespace afterglow {
namespace {

/// `part` of rows of `width` pixels.
template <class Values>
Values cut(const Values& pixels, int width, int channels, const Rect& part) {
  Values out;
  out.reserve(static_cast<std::size_t>(part.size().area() * channels));
  for (int y = 0; y < part.height; ++y) {
    const auto row = pixels.begin() + (static_cast<std::ptrdiff_t>(part.y + y) * width + part.x) * channels;
    out.insert(out.end(), row, row + static_cast<std::ptrdiff_t>(part.width) * channels);
  }
  return out;
}

void cut(Image& image, const Rect& part) {
  image.pixels = cut(image.pixels, image.width, image.channels, part);
  image.width = part.width;
  image.height = part.height;
}

}  // namespace

Result<Rect> part_of_region(const Rect& region, const Rect& data_window, const Rect& display_window) {
  const auto text = fmt::format("the region {},{},{},{}", region.x, region.y, region.width, region.height);
  if (region.x + region.width > display_window.width || region.y + region.height > display_window.height)
    return Error{ErrorKind::io, fmt::format("{} reaches beyond the picture, which has {}×{} pixels", text,
                                            display_window.width, display_window.height)};
  const int x = display_window.x + region.x - data_window.x, y = display_window.y + region.y - data_window.y;
  const int left = std::max(x, 0), right = std::min(x + region.width, data_window.width);
  const int top = std::max(y, 0), bottom = std::min(y + region.height, data_window.height);
  if (left >= right || top >= bottom)
    return Error{ErrorKind::io, fmt::format("{} lies outside the picture's data window", text)};
  return Rect{left, top, right - left, bottom - top};
}

void crop_picture(Picture& picture, const Rect& region, const Rect& part) {
  if (!picture.unorm8.empty()) picture.unorm8 = cut(picture.unorm8, picture.color.width, 4, part);
  open_color(picture);
  cut(picture.color, part);
  for (auto& [name, image] : picture.auxiliary) cut(image, part);
  picture.content.clear();
  const Rect& display = picture.display_window;
  picture.data_window = {picture.data_window.x + part.x - display.x - region.x,
                         picture.data_window.y + part.y - display.y - region.y, part.width, part.height};
  picture.display_window = {0, 0, region.width, region.height};
}

}  // namespace afterglow
