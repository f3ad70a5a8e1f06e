// SPDX-License-Identifier: MIT
#include "reference/glare.h"

#include <cmath>

#include "reference/box_bloom.h"
#include "reference/grain.h"
#include "reference/image_overlay.h"
#include "reference/lens.h"
#include "reference/resample.h"

namespace afterglow::reference {

namespace {

/// What exceeds the threshold, at half the size.
DoubleImage bright_half(const DoubleImage& source, double threshold) {
  const auto bright =
      map_color(source, [&](const Rgb& c) { return box_bloom_threshold(c, threshold, BoxBrightness::max); });
  return resample(bright, halved(source.size()), {});
}

Words words_of(int i, int j, const LensDirt& s, std::uint32_t number) {
  return pcg3d({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j), 8 * s.seed + number});
}

/// At most one grain in each cell; its rim is brighter than its middle.
double grains(double x, double y, const LensDirt& s, std::uint32_t number) {
  const int home_x = static_cast<int>(std::floor(x)), home_y = static_cast<int>(std::floor(y));
  double sum = 0;
  for (int j = home_y - 1; j <= home_y + 1; ++j)
    for (int i = home_x - 1; i <= home_x + 1; ++i) {
      const Words place = words_of(i, j, s, number), kind = pcg3d(place);
      const double radius = 0.08 + 0.42 * unit(kind[0]) * unit(kind[0]);
      const double inside = 1 - std::hypot(x - i - unit(place[0]), y - j - unit(place[1])) / radius;
      const double there = glm::clamp((s.density - unit(place[2])) / 0.05, 0.0, 1.0);
      const double opacity = there * (0.05 + 0.95 * std::pow(unit(kind[2]), 3));
      sum += opacity * glm::clamp(inside / (0.2 + 0.6 * unit(kind[1])), 0.0, 1.0) *
             (1 - 0.5 * glm::clamp(inside * 2.5, 0.0, 1.0));
    }
  return sum;
}

double smooth_noise(double x, double y, const LensDirt& s, std::uint32_t number) {
  const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
  const auto ease = [](double t) { return t * t * (3 - 2 * t); };
  const double u = ease(x - i), v = ease(y - j);
  const auto at = [&](int di, int dj) { return unit(words_of(i + di, j + dj, s, number)[0]); };
  return (at(0, 0) * (1 - u) + at(1, 0) * u) * (1 - v) + (at(0, 1) * (1 - u) + at(1, 1) * u) * v;
}

DoubleImage through_texture(const DoubleImage& source, const DoubleImage& light, const LensDirt& s) {
  const DoubleImage over = covering(*s.texture, source.size());
  return generate(source.size(), [&](int x, int y) {
    const Rgba& p = source.at(x, y);
    return Rgba(Rgb(p) + s.intensity * Rgb(over.at(x, y)) * Rgb(light.at(x, y)), p.a);
  });
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

DoubleImage lens_dirt_spots(Size size, double cell, const LensDirt& s) {
  return generate(size, [&](int x, int y) {
    const double px = (x + 0.5) / cell, py = (y + 0.5) / cell;
    const double cloud = 0.5 * smooth_noise(px / 4, py / 4, s, 2) + 0.3 * smooth_noise(px / 1.5, py / 1.5, s, 3) +
                         0.2 * smooth_noise(px * 2, py * 2, s, 4);
    const double smudges = s.density * glm::clamp(2.5 * cloud - 1, 0.0, 1.0);
    return Rgba(glm::min(0.5 * smudges + 1.5 * grains(px, py, s, 0) + 0.8 * grains(4 * px, 4 * py, s, 1), 1.0));
  });
}

DoubleImage lens_dirt(const DoubleImage& source, const LensDirt& s) {
  Filter tent;
  tent.x = tent.y = {{-1, 0.25}, {0, 0.5}, {1, 0.25}};
  DoubleImage light = bright_half(source, s.threshold);
  while (glm::min(light.width, light.height) >= 16) light = resample(light, halved(light.size()), tent);
  const Filter enlarge{.interpolation = Interpolation::cubic_bspline};
  if (s.texture) return through_texture(source, resample(light, source.size(), enlarge), s);
  const Size small{(source.width + 3) / 4, (source.height + 3) / 4};
  light = resample(light, small, enlarge);
  const DoubleImage spots = lens_dirt_spots(small, glm::max(s.size * source.height / 4, 1.0), s);
  for (std::size_t i = 0; i < light.pixels.size(); ++i) light.pixels[i] *= spots.pixels[i].r;
  light = resample(light, source.size(), enlarge);
  return generate(source.size(), [&](int x, int y) {
    const Rgba& p = source.at(x, y);
    return Rgba(Rgb(p) + s.intensity * Rgb(light.at(x, y)), p.a);
  });
}

}  // namespace afterglow::reference
