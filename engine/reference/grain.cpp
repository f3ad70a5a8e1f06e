// SPDX-License-Identifier: MIT
#include "reference/grain.h"

#include <algorithm>
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

/// lowbias32 (Wellons, 2018).
std::uint32_t word_of(std::uint32_t x) {
  x = (x ^ (x >> 16u)) * 0x7feb352du;
  x = (x ^ (x >> 15u)) * 0x846ca68bu;
  return x ^ (x >> 16u);
}

std::uint32_t key_of(const FilmGrain& s) { return word_of(word_of(s.seed) + s.frame); }

/// Red, green, blue, grey. `own`: beside cells, which have the numbers of pixels, too, pixels have a key of their own.
Rgba cell_noise(int x, int y, const FilmGrain& s, bool own = false) {
  const std::uint32_t key = (key_of(s) & 0x7fffffffu) ^ static_cast<std::uint32_t>(y);
  const std::uint32_t row = word_of(own ? key ^ 0x80000000u : key);
  const std::uint32_t w = word_of(row + static_cast<std::uint32_t>(x) * 0x9e3779b9u);
  return {normal(word_of(w + 1)), normal(word_of(w + 2)), normal(word_of(w + 3)), normal(w)};
}

/// The quadratic B-spline at a distance in cells.
double spline(double d) {
  d = std::abs(d);
  return d < 0.5 ? 0.75 - d * d : d < 1.5 ? 0.5 * (1.5 - d) * (1.5 - d) : 0;
}

/// Quadratic B-splines of cells, which lie elsewhere in each frame; the weights are scaled so that their squares add
/// up to 1.
Rgba coarse_noise(int x, int y, const FilmGrain& s) {
  const double side = s.size * std::sqrt(2.0 / 3);
  const std::uint32_t key = key_of(s);
  const double px = (x + 0.5 + (key >> 24u) / 16.0) / side, py = (y + 0.5 + (key >> 16u & 255u) / 16.0) / side;
  const int cx = static_cast<int>(std::floor(px)), cy = static_cast<int>(std::floor(py));
  Rgba sum(0);
  double squares = 0;
  for (int j = cy - 1; j <= cy + 1; ++j)
    for (int i = cx - 1; i <= cx + 1; ++i) {
      const double weight = spline(px - i - 0.5) * spline(py - j - 0.5);
      sum += weight * cell_noise(i, j, s);
      squares += weight * weight;
    }
  return sum / std::sqrt(squares);
}

/// From 1 to 1.5 pixels the grain of single pixels gives way to that of cells.
Rgba noise(int x, int y, const FilmGrain& s) {
  const double share = std::min(2 * (s.size - 1), 1.0);
  const Rgba fine = cell_noise(x, y, s, share > 0);
  if (share == 0) return fine;
  const Rgba coarse = coarse_noise(x, y, s);
  return (fine + share * (coarse - fine)) / std::hypot(share, 1 - share);
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
    const Rgb grey(each.a), coloured(each);
    const Rgb n = (grey + s.colored * (coloured - grey)) / std::hypot(s.colored, 1 - s.colored);
    const Rgba& p = source.at(x, y);
    const double dark = 1 - std::sqrt(glm::clamp(luminance(Rgb(p) / cover(p)), 0.0, 1.0));
    const double response = 1 + (dark - 1) * s.response;
    return Rgba(glm::max(Rgb(p) + Rgb(p) * n * (0.25 * s.intensity * response), Rgb(0)), p.a);
  });
}

}  // namespace afterglow::reference
