// SPDX-License-Identifier: MIT
#include "reference/detail.h"

#include <algorithm>
#include <cmath>

#include "reference/color.h"

namespace afterglow::reference {

double perceived(const Rgb& c) { return std::sqrt(luminance(glm::clamp(c, Rgb(0), Rgb(1)))); }

DoubleImage sharpen(const DoubleImage& source, double intensity, double contrast) {
  const double peak = -1 / (8 + (5 - 8) * contrast);
  return generate(source.size(), [&](int x, int y) {
    const auto at = [&](int dx, int dy) { return Rgb(source.clamped(x + dx, y + dy)); };
    const Rgb e = at(0, 0), b = at(0, -1), d = at(-1, 0), f = at(1, 0), h = at(0, 1);
    Rgb out;
    for (int i = 0; i < 3; ++i) {
      const double low = std::min({b[i], d[i], e[i], f[i], h[i]}), high = std::max({b[i], d[i], e[i], f[i], h[i]});
      const double corners_low = std::min({at(-1, -1)[i], at(1, -1)[i], at(-1, 1)[i], at(1, 1)[i]});
      const double corners_high = std::max({at(-1, -1)[i], at(1, -1)[i], at(-1, 1)[i], at(1, 1)[i]});
      const double mn = low + std::min(low, corners_low), mx = high + std::max(high, corners_high);
      const double weight = mx > 0 ? std::sqrt(saturate(std::min(mn, 2 - mx) / mx)) * peak : 0;
      const double sharp = (b[i] * weight + d[i] * weight + f[i] * weight + h[i] * weight + e[i]) / (1 + 4 * weight);
      out[i] = e[i] + intensity * (std::max(sharp, 0.0) - e[i]);
    }
    return Rgba(out, source.at(x, y).a);
  });
}

DoubleImage pixelate(const DoubleImage& source, double size) {
  const double side = std::floor(size * 65536 + 0.5) / 65536;
  // The light in a rectangle, whose edges may lie within pixels, over its area.
  const auto mean = [&](double left, double top, double right, double bottom) {
    Rgb sum(0);
    for (int j = static_cast<int>(top); j < bottom; ++j)
      for (int i = static_cast<int>(left); i < right; ++i)
        sum += Rgb(source.at(i, j)) * ((std::min(i + 1.0, right) - std::max<double>(i, left)) *
                                       (std::min(j + 1.0, bottom) - std::max<double>(j, top)));
    return sum / ((right - left) * (bottom - top));
  };
  return generate(source.size(), [&](int x, int y) {
    Rgb shown(0);
    for (double top = std::floor(y / side) * side; top < y + 1; top += side)
      for (double left = std::floor(x / side) * side; left < x + 1; left += side)
        shown +=
            mean(left, top, std::min<double>(left + side, source.width), std::min<double>(top + side, source.height)) *
            ((std::min(left + side, x + 1.0) - std::max<double>(left, x)) *
             (std::min(top + side, y + 1.0) - std::max<double>(top, y)));
    return Rgba(shown, source.at(x, y).a);
  });
}

DoubleImage edge_detection(const DoubleImage& source, const EdgeDetection& s) {
  const int around = s.apart / 2;
  const DoubleImage mean = generate(source.size(), [&](int x, int y) {
    Rgba sum(0);
    for (int j = -around; j <= around; ++j)
      for (int i = -around; i <= around; ++i) sum += source.clamped(x + i, y + j);
    return sum / static_cast<double>(s.apart * s.apart);
  });
  return generate(source.size(), [&](int x, int y) {
    const auto at = [&](int dx, int dy) { return perceived(Rgb(mean.clamped(x + s.apart * dx, y + s.apart * dy))); };
    double gx, gy;
    if (s.kind == EdgeOperator::roberts) {
      gx = (at(0, 0) - at(1, 1)) / std::sqrt(2.0);
      gy = (at(1, 0) - at(0, 1)) / std::sqrt(2.0);
    } else {
      const double side = s.kind == EdgeOperator::scharr ? 3.0 / 16 : 1.0 / 4, middle = 1 - 2 * side;
      gx = side * (at(1, -1) - at(-1, -1)) + middle * (at(1, 0) - at(-1, 0)) + side * (at(1, 1) - at(-1, 1));
      gy = side * (at(-1, 1) - at(-1, -1)) + middle * (at(0, 1) - at(0, -1)) + side * (at(1, 1) - at(1, -1));
    }
    const double line = saturate((std::hypot(gx, gy) - s.threshold) * s.intensity);
    const Rgba& p = source.at(x, y);
    const Rgb below = Rgb(p) + s.background_opacity * (s.background * p.a - Rgb(p));
    return Rgba(below + line * (s.color * p.a - below), p.a);
  });
}

}  // namespace afterglow::reference
