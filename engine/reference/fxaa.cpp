// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <vector>

#include "reference/detail.h"

namespace afterglow::reference {

namespace {

struct Direction {
  int x, y;
};

/// The end of an edge in one direction: how far it is, and luma there less luma of the edge.
struct End {
  double distance, difference;
};

End find_end(const DoubleImage& luma, double x, double y, Direction step, double edge, double threshold,
             const std::vector<double>& steps) {
  constexpr double kLastGuess = 8;
  const auto difference = [&](double d) { return sample_linear(luma, x + d * step.x, y + d * step.y).r - edge; };
  double distance = 1;
  for (const double s : steps) {
    if (std::abs(difference(distance)) >= threshold) break;
    distance += s;
  }
  const double last = difference(distance);
  return {std::abs(last) >= threshold ? distance : distance + kLastGuess, last};
}

std::vector<double> steps_of(FxaaQuality quality) {
  if (quality == FxaaQuality::low) return {1.5, 2, 2};
  if (quality == FxaaQuality::medium) return {1.5, 2, 2, 2, 2, 2, 2, 4};
  return {1, 1, 1, 1, 1.5, 2, 2, 2, 2, 4};
}

}  // namespace

DoubleImage fxaa(const DoubleImage& source, const Fxaa& s) {
  DoubleImage luma = source;
  for (auto& p : luma.pixels) p = Rgba(perceived(Rgb(p)));
  const auto steps = steps_of(s.quality);

  return generate(source.size(), [&](int x, int y) {
    const auto at = [&](int dx, int dy) { return luma.clamped(x + dx, y + dy).r; };
    const double m = at(0, 0), n = at(0, -1), e = at(1, 0), south = at(0, 1), w = at(-1, 0);
    const double highest = std::max({m, n, e, south, w}), range = highest - std::min({m, n, e, south, w});
    if (range < std::max(s.fixed_threshold, s.relative_threshold * highest)) return source.at(x, y);

    const double ne = at(1, -1), se = at(1, 1), sw = at(-1, 1), nw = at(-1, -1);
    double blend = (2 * (n + e + south + w) + ne + nw + se + sw) / 12;
    blend = std::min(std::abs(blend - m) / range, 1.0);
    blend = blend * blend * (3 - 2 * blend);
    blend = blend * blend * s.subpixel_blending;

    const double change_down = 2 * std::abs(n + south - 2 * m) + std::abs(ne + se - 2 * e) + std::abs(nw + sw - 2 * w);
    const double change_across =
        2 * std::abs(e + w - 2 * m) + std::abs(ne + nw - 2 * n) + std::abs(se + sw - 2 * south);
    const bool horizontal = change_down >= change_across - 1e-5;  // often equal, but for rounding
    Direction across = horizontal ? Direction{0, 1} : Direction{1, 0};
    const Direction along = horizontal ? Direction{1, 0} : Direction{0, 1};
    if (std::abs(at(-across.x, -across.y) - m) >= std::abs(at(across.x, across.y) - m)) across = {-across.x, -across.y};
    const double other = at(across.x, across.y);

    const double edge = (m + other) / 2, threshold = std::abs(other - m) / 4 - 1e-5;  // the same
    const double edge_x = x + 0.5 + 0.5 * across.x, edge_y = y + 0.5 + 0.5 * across.y;
    const End p = find_end(luma, edge_x, edge_y, along, edge, threshold, steps);
    const End q = find_end(luma, edge_x, edge_y, {-along.x, -along.y}, edge, threshold, steps);
    const End nearest = p.distance <= q.distance ? p : q;
    const bool moves_away = (nearest.difference >= 0) != (m - edge >= 0);
    if (moves_away) blend = std::max(blend, 0.5 - nearest.distance / (p.distance + q.distance));

    return Rgba(Rgb(sample_linear(source, x + 0.5 + blend * across.x, y + 0.5 + blend * across.y)), source.at(x, y).a);
  });
}

}  // namespace afterglow::reference
