// SPDX-License-Identifier: MIT
#include "reference/lens.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace afterglow::reference {

namespace {

constexpr double kRightAngle = std::numbers::pi / 2 - 1e-6;  ///< rays beyond it come from nowhere: the edge is read

Point uv_of(int x, int y, Size size) { return {(x + 0.5) / size.width, (y + 0.5) / size.height}; }

Rgba read(const DoubleImage& image, Point uv) {
  uv = glm::clamp(uv, Point(0), Point(1));
  return sample_linear(image, uv.x * image.width, uv.y * image.height);
}

}  // namespace

DoubleImage vignette(const DoubleImage& source, const Vignette& s) {
  return generate(source.size(), [&](int x, int y) {
    Point d = glm::abs(uv_of(x, y, source.size()) - s.center) * (3 * s.intensity);
    if (s.rounded) d.x *= static_cast<double>(source.width) / source.height;
    const double kept = std::pow(glm::clamp(1 - glm::dot(d, d), 0.0, 1.0), 5 * s.smoothness);
    const Rgba& p = source.at(x, y);
    return Rgba(Rgb(p) * (s.color + kept * (Rgb(1) - s.color)), p.a);
  });
}

namespace {

/// Integrals of (a + bt)(c + dt), exact for Simpson's rule, over [from, to].
template <class F>
double simpson(const F& f, double from, double to) {
  return (to - from) / 6 * (f(from) + 4 * f(0.5 * (from + to)) + f(to));
}

/// Integral of spectrum · tent over the tent around pixel i of a way of `length`: pieces between the kinks of both.
Rgb weight_of(int i, double length) {
  Rgb sum(0);
  double ends[] = {i - 1.0, double(i), i + 1.0, 0.0, 0.5 * length, length};
  std::sort(std::begin(ends), std::end(ends));
  for (int k = 0; k + 1 < 6; ++k) {
    const double from = std::clamp(ends[k], std::max(i - 1.0, 0.0), std::max(0.0, std::min(i + 1.0, length)));
    const double to = std::clamp(ends[k + 1], from, std::max(from, std::min(i + 1.0, length)));
    for (int c = 0; c < 3; ++c)
      sum[c] += simpson(
          [&](double s) {
            const double t = s / length;
            const double light = c == 0   ? std::max(0.0, 1 - 2 * t)
                                 : c == 1 ? 1 - std::abs(2 * t - 1)
                                          : std::max(0.0, 2 * t - 1);
            return light * (1 - std::abs(s - i));
          },
          from, to);
  }
  return sum;
}

}  // namespace

DoubleImage chromatic_aberration(const DoubleImage& source, double intensity, int samples) {
  return generate(source.size(), [&](int x, int y) {
    const Point uv = uv_of(x, y, source.size()), coords = 2.0 * uv - 1.0;
    const Point end = uv - coords * glm::dot(coords, coords) * (intensity * 0.05 * 2 / 3);
    const Rgba color = source.at(x, y);
    if (samples == 3) return Rgba(color.r, read(source, 0.5 * (uv + end)).g, read(source, end).b, color.a);
    const Point way = (end - uv) * Point(source.width, source.height);
    const double length = std::max({std::abs(way.x), std::abs(way.y), 1e-6});
    Rgb sum(0), weights(0);
    for (int i = 0; i <= static_cast<int>(std::ceil(length)); ++i) {
      const Rgb weight = weight_of(i, length);
      sum += weight * Rgb(read(source, uv + (end - uv) * (i / length)));
      weights += weight;
    }
    return Rgba(sum / weights, color.a);
  });
}

DoubleImage lens_distortion(const DoubleImage& source, const LensDistortion& s) {
  const double theta = glm::min(1.6 * glm::max(std::abs(s.intensity) * 100, 1.0), 160.0) * std::numbers::pi / 180;
  const double sigma = 2 * std::tan(theta / 2);
  const Point axes(glm::max(s.x_multiplier, 1e-4), glm::max(s.y_multiplier, 1e-4));
  return generate(source.size(), [&](int x, int y) {
    Point uv = s.center + (uv_of(x, y, source.size()) - s.center) / s.scale;
    const Point ray = axes * (uv - s.center);
    const double r = glm::length(ray);
    if (s.intensity != 0 && r > 0)
      uv += ray * ((s.intensity > 0 ? std::tan(std::min(r * theta, kRightAngle)) / (r * sigma)
                                    : std::atan(r * sigma) / (r * theta)) -
                   1);
    double inside = 1;
    for (int axis = 0; axis < 2; ++axis) {
      const double side = axis == 0 ? source.width : source.height;
      if (s.edges == LensEdges::mirror) uv[axis] = std::abs(uv[axis] - 2 * std::round(uv[axis] / 2));
      // Of bilinear reads among black pixels beyond the edge.
      if (s.edges == LensEdges::black) inside *= glm::clamp(glm::min(uv[axis], 1 - uv[axis]) * side + 0.5, 0.0, 1.0);
    }
    return Rgba(Rgb(read(source, uv)) * inside, source.at(x, y).a);
  });
}

}  // namespace afterglow::reference
