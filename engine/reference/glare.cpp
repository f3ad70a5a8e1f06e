// SPDX-License-Identifier: MIT
#include "reference/glare.h"

#include <cmath>

#include "reference/box_bloom.h"
#include "reference/grain.h"
#include "reference/lens.h"
#include "reference/resample.h"

namespace afterglow::reference {

namespace {

Size half(Size size) { return {glm::max(size.width / 2, 1), glm::max(size.height / 2, 1)}; }

/// Half size, then what exceeds the threshold.
DoubleImage bright_half(const DoubleImage& source, double threshold) {
  return map_color(resample(source, half(source.size()), {}),
                   [&](const Rgb& c) { return box_bloom_threshold(c, threshold, BoxBrightness::max); });
}

double layer(double x, double y, const LensDirt& s, std::uint32_t number) {
  const int home_x = static_cast<int>(std::floor(x)), home_y = static_cast<int>(std::floor(y));
  double sum = 0;
  for (int j = home_y - 1; j <= home_y + 1; ++j)
    for (int i = home_x - 1; i <= home_x + 1; ++i) {
      const Words place = pcg3d({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j), 2 * s.seed + number});
      const Words kind = pcg3d(place);
      if (unit(place[2]) >= s.density) continue;
      const double radius = 0.1 + 0.4 * unit(kind[0]), softness = 0.1 + 0.9 * unit(kind[1]);
      const double distance = std::hypot(x - i - unit(place[0]), y - j - unit(place[1]));
      const double opacity = 0.1 + 0.9 * unit(kind[2]) * unit(kind[2]);
      sum += opacity * glm::clamp((radius - distance) / (radius * softness), 0.0, 1.0);
    }
  return sum;
}

}  // namespace

DoubleImage anamorphic_streaks(const DoubleImage& source, const AnamorphicStreaks& s) {
  Filter halving;
  halving.x = {{-1.5, 0.125}, {-0.5, 0.375}, {0.5, 0.375}, {1.5, 0.125}};
  std::vector<DoubleImage> levels{bright_half(source, s.threshold)};
  while (levels.back().width >= 8)
    levels.push_back(resample(levels.back(), {levels.back().width / 2, levels.back().height}, halving));
  DoubleImage streaks = levels.back();
  for (std::size_t i = levels.size() - 1; i-- > 0;) {
    const DoubleImage up = resample(streaks, levels[i].size(), {});
    streaks = generate(
        up.size(), [&](int x, int y) { return levels[i].at(x, y) + s.stretch * (up.at(x, y) - levels[i].at(x, y)); });
  }
  streaks = resample(streaks, source.size(), {});
  return generate(source.size(), [&](int x, int y) {
    const Rgba& p = source.at(x, y);
    return Rgba(Rgb(p) + s.intensity * s.tint * Rgb(streaks.at(x, y)), p.a);
  });
}

DoubleImage lens_dirt_spots(Size size, const LensDirt& s) {
  const double cell = glm::max(s.size * size.height, 2.0);
  return generate(size, [&](int x, int y) {
    const double px = (x + 0.5) / cell, py = (y + 0.5) / cell;
    return Rgba(glm::min(0.6 * layer(px, py, s, 0) + 0.4 * layer(4 * px, 4 * py, s, 1), 1.0));
  });
}

DoubleImage lens_dirt(const DoubleImage& source, const LensDirt& s) {
  Filter tent;
  tent.x = tent.y = {{-1, 0.25}, {0, 0.5}, {1, 0.25}};
  DoubleImage light = bright_half(source, s.threshold);
  while (glm::min(light.width, light.height) >= 16) light = resample(light, half(light.size()), tent);
  light = resample(light, source.size(), {.interpolation = Interpolation::cubic_bspline});
  const DoubleImage spots = lens_dirt_spots(source.size(), s);
  return generate(source.size(), [&](int x, int y) {
    const Rgba& p = source.at(x, y);
    return Rgba(Rgb(p) + s.intensity * spots.at(x, y).r * Rgb(light.at(x, y)), p.a);
  });
}

}  // namespace afterglow::reference
