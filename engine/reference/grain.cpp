// SPDX-License-Identifier: MIT
#include "reference/grain.h"

#include <cmath>

#include "reference/color.h"

namespace afterglow::reference {

namespace {

/// Sum of a word's four bytes, less its mean, over its deviation: √(4·(256² − 1)/12).
double normal(std::uint32_t word) {
  double sum = -510;
  for (int i = 0; i < 4; ++i) sum += (word >> (8 * i)) & 255u;
  return sum / std::sqrt(4 * 65535.0 / 12);
}

/// Red, grey, blue, green.
Rgba cell_noise(int x, int y, const FilmGrain& s) {
  const Words w =
      pcg3d({static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y) + (s.seed << 16u), s.frame + s.seed});
  return {normal(w[0]), normal(w[1]), normal(w[2]), normal(pcg3d(w)[1])};
}

/// Bilinear between cells; the weights are scaled so that their squares add up to 1.
Rgba noise(int x, int y, const FilmGrain& s) {
  const double px = (x + 0.5) / s.size - (s.size == 1 ? 0.5 : 0), py = (y + 0.5) / s.size - (s.size == 1 ? 0.5 : 0);
  const int cx = static_cast<int>(std::floor(px)), cy = static_cast<int>(std::floor(py));
  const double wx[2] = {1 - (px - cx), px - cx}, wy[2] = {1 - (py - cy), py - cy};
  Rgba sum(0);
  double squares = 0;
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      sum += wx[i] * wy[j] * cell_noise(cx + i, cy + j, s);
      squares += wx[i] * wy[j] * wx[i] * wy[j];
    }
  return sum / std::sqrt(squares);
}

}  // namespace

Words pcg3d(Words v) {
  const auto mix = [&] {
    v[0] += v[1] * v[2];
    v[1] += v[2] * v[0];
    v[2] += v[0] * v[1];
  };
  for (auto& word : v) word = word * 1664525u + 1013904223u;
  mix();
  for (auto& word : v) word ^= word >> 16u;
  mix();
  return v;
}

DoubleImage film_grain(const DoubleImage& source, const FilmGrain& s) {
  return generate(source.size(), [&](int x, int y) {
    const Rgba each = noise(x, y, s);
    const Rgb grey(each.g), coloured(each.r, each.a, each.b);
    const Rgb n = (grey + s.colored * (coloured - grey)) / std::hypot(s.colored, 1 - s.colored);
    const Rgba& p = source.at(x, y);
    const double dark = 1 - std::sqrt(glm::clamp(luminance(Rgb(p) / cover(p)), 0.0, 1.0));
    const double response = 1 + (dark - 1) * s.response;
    return Rgba(glm::max(Rgb(p) + Rgb(p) * n * (0.25 * s.intensity * response), Rgb(0)), p.a);
  });
}

}  // namespace afterglow::reference
