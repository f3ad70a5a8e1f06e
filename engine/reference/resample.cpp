// SPDX-License-Identifier: MIT
#include "reference/resample.h"

namespace afterglow::reference {

namespace {

Rgba sample(const DoubleImage& image, Interpolation interpolation, double px, double py) {
  switch (interpolation) {
    case Interpolation::nearest:
      return sample_nearest(image, px, py);
    case Interpolation::linear:
      return sample_linear(image, px, py);
    case Interpolation::cubic_bspline:
      return sample_bspline(image, px, py);
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
    for (const auto& tap : taps) sum += tap.weight * sample(source, filter.interpolation, px + tap.dx, py + tap.dy);
    return sum;
  });
}

}  // namespace afterglow::reference
