// SPDX-License-Identifier: MIT
#include "reference/resample.h"

#include <cmath>

namespace afterglow::reference {

namespace {

Rgba sample(const DoubleImage& image, const Filter& filter, double px, double py) {
  switch (filter.interpolation) {
    case Interpolation::nearest:
      return sample_nearest(image, px, py, filter.edges);
    case Interpolation::linear:
      return sample_linear(image, px, py, filter.edges);
    case Interpolation::cubic_bspline:
      return sample_bspline(image, px, py, filter.edges);
  }
  return Rgba(0);
}

}  // namespace

Size halved(Size size) { return {glm::max(size.width / 2, 1), glm::max(size.height / 2, 1)}; }

DoubleImage resample(const DoubleImage& source, Size size, const Filter& filter) {
  std::vector<Tap2d> taps = filter.taps;
  if (filter.separable())
    for (const auto& y : filter.y)
      for (const auto& x : filter.x) taps.push_back({x.offset, y.offset, x.weight * y.weight});

  return generate(size, [&](int x, int y) {
    const double px = source_position(x, source.width, size.width);
    const double py = source_position(y, source.height, size.height);
    Rgba sum(0);
    for (const auto& tap : taps) sum += tap.weight * sample(source, filter, px + tap.dx, py + tap.dy);
    return sum;
  });
}

DoubleImage resized_to(DoubleImage image, Size size) {
  for (Size half = halved(image.size()); half.width >= size.width && half.height >= size.height && half != image.size();
       half = halved(half))
    image = resample(image, half, {});
  if (image.size() == size) return image;
  const auto area = [](int from, int to) {
    const double ratio = static_cast<double>(from) / to;
    const int count = ratio > 1 ? static_cast<int>(std::ceil(2 * ratio)) : 1;
    std::vector<Tap> taps;
    for (int i = 0; i < count; ++i) taps.push_back({((i + 0.5) / count - 0.5) * ratio, 1.0 / count});
    return taps;
  };
  Filter filter;
  filter.x = area(image.width, size.width);
  filter.y = area(image.height, size.height);
  return resample(image, size, filter);
}

}  // namespace afterglow::reference
