// SPDX-License-Identifier: MIT
#include "reference/double_image.h"

#include <cmath>

namespace afterglow::reference {

DoubleImage from_floats(const float* pixels, Size size, int channels) {
  return generate(size, [&](int x, int y) {
    Rgba p(0, 0, 0, 1);
    const float* from = pixels + (static_cast<std::size_t>(y) * size.width + x) * channels;
    for (int c = 0; c < glm::min(channels, 4); ++c) p[c] = static_cast<double>(from[c]);
    return p;
  });
}

std::vector<double> interleaved(const DoubleImage& image) {
  std::vector<double> out;
  out.reserve(image.pixels.size() * 4);
  for (const auto& p : image.pixels) out.insert(out.end(), {p.r, p.g, p.b, p.a});
  return out;
}

Rgba sample_nearest(const DoubleImage& image, double px, double py, Edges edges) {
  return image.beyond(static_cast<int>(std::floor(px)), static_cast<int>(std::floor(py)), edges);
}

Rgba sample_linear(const DoubleImage& image, double px, double py, Edges edges) {
  const double tx = px - 0.5, ty = py - 0.5;
  const double ix = std::floor(tx), iy = std::floor(ty);
  const double fx = tx - ix, fy = ty - iy;
  const int x = static_cast<int>(ix), y = static_cast<int>(iy);
  const Rgba top = (1 - fx) * image.beyond(x, y, edges) + fx * image.beyond(x + 1, y, edges);
  const Rgba bottom = (1 - fx) * image.beyond(x, y + 1, edges) + fx * image.beyond(x + 1, y + 1, edges);
  return (1 - fy) * top + fy * bottom;
}

glm::dvec4 bspline_weights(double t) {
  const double u = 1 - t;
  return {u * u * u / 6, 2.0 / 3 - t * t + t * t * t / 2, 1.0 / 6 + t / 2 + t * t / 2 - t * t * t / 2, t * t * t / 6};
}

Rgba sample_bspline(const DoubleImage& image, double px, double py, Edges edges) {
  const double cx = std::floor(px + 0.5), cy = std::floor(py + 0.5);
  const auto wx = bspline_weights(px + 0.5 - cx), wy = bspline_weights(py + 0.5 - cy);
  const int x = static_cast<int>(cx) - 2, y = static_cast<int>(cy) - 2;
  Rgba sum(0);
  for (int j = 0; j < 4; ++j) {
    Rgba row(0);
    for (int i = 0; i < 4; ++i) row += wx[i] * image.beyond(x + i, y + j, edges);
    sum += wy[j] * row;
  }
  return sum;
}

}  // namespace afterglow::reference
