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

std::vector<Tap> mean_over(double ratio) {
  if (ratio <= 1) return {{0, 1}};
  const bool whole = ratio == std::floor(ratio);
  const int n = static_cast<int>(whole ? ratio : std::ceil(2 * ratio));
  std::vector<Tap> taps;
  for (int i = 0; i < n; ++i) taps.push_back({(i - (n - 1) / 2.0) * ratio / n, 1.0 / n});
  return taps;
}

DoubleImage resized_to(DoubleImage image, Size size) {
  for (Size half = halved(image.size()); half.width >= size.width && half.height >= size.height && half != image.size();
       half = halved(half))
    image = resample(image, half, {});
  if (image.size() == size) return image;
  Filter filter;
  filter.x = mean_over(static_cast<double>(image.width) / size.width);
  filter.y = mean_over(static_cast<double>(image.height) / size.height);
  return resample(image, size, filter);
}

}  // namespace afterglow::reference
