// SPDX-License-Identifier: MIT
#include "reference/smaa.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace afterglow::reference {
namespace {

using Shares = std::array<double, 2>;  ///< on the pixel's side of its edge, on its neighbour's

double smaa_luma(const Rgba& p) {
  const auto held = [](double v) { return std::clamp(v, 0.0, 1.0); };
  return std::sqrt(0.2126729 * held(p.r) + 0.7151522 * held(p.g) + 0.0721750 * held(p.b));
}

/// Edges as a picture that may be turned: a horizontal edge of the turned one is a vertical edge.
struct EdgeMap {
  const DoubleImage& edges;
  bool turned;
  int columns() const { return turned ? edges.height : edges.width; }
  const Rgba& at(int x, int y) const { return turned ? edges.clamped(y, x) : edges.clamped(x, y); }
  bool upper(int x, int y) const { return (turned ? at(x, y).r : at(x, y).g) > 0; }
  bool side(int x, int y) const { return (turned ? at(x, y).g : at(x, y).r) > 0; }
};

/// Integral over [x, x + 1] of the positive and of the negative part of the line from (x0, y0) to (x1, y1), by halving
/// at its zero.
Shares area_beside(double x0, double y0, double x1, double y1, double x) {
  const double from = std::max(x, x0), to = std::min(x + 1, x1);
  if (to <= from) return {0, 0};
  const auto line = [&](double at) { return y0 + (y1 - y0) * (at - x0) / (x1 - x0); };
  double zero = y1 == y0 ? from : x0 - y0 * (x1 - x0) / (y1 - y0);
  zero = std::clamp(zero, from, to);
  Shares out{0, 0};
  for (const auto& [a, b] : {std::pair{from, zero}, std::pair{zero, to}}) {
    const double part = (line(a) + line(b)) / 2 * (b - a);
    out[part > 0 ? 0 : 1] += std::abs(part);
  }
  return out;
}

/// Which way the outline leaves an edge at its end: 1 into the pixel's row, −1 into its neighbour's, 0 not.
std::pair<int, int> ways_out(bool near1, bool far1, bool near2, bool far2) {
  const auto plain = [](bool near, bool far) { return near && far ? 2 : near ? 1 : far ? -1 : 0; };
  int a = plain(near1, far1), b = plain(near2, far2);
  const int a0 = a, b0 = b;
  if (a0 == 2) a = b0 == 1 || b0 == -1 ? -b0 : 0;
  if (b0 == 2) b = a0 == 1 || a0 == -1 ? -a0 : 0;
  return {a, b};
}

Shares edge_shares(const EdgeMap& map, int x, int y, const Smaa& s) {
  int left = 0, right = 0;
  const auto crossed = [&](int at) { return map.side(at, y) || map.side(at, y - 1); };
  while (!crossed(x - left) && left < s.search && x - left > 0 && map.upper(x - left - 1, y)) ++left;
  const auto at_border = [&] { return x + right + 1 >= map.columns(); };
  while (!at_border() && !crossed(x + right + 1) && right < s.search && map.upper(x + right + 1, y)) ++right;
  const int start = x - left, end = x + right + 1;
  const bool ends = at_border();
  const auto [a, b] =
      ways_out(map.side(start, y), map.side(start, y - 1), !ends && map.side(end, y), !ends && map.side(end, y - 1));
  const double length = left + right + 1, middle = length / 2;
  Shares out{0, 0};
  if (a != 0 && b == -a) {
    out = area_beside(0, a / 2.0, length, b / 2.0, left);
  } else if (a != 0 && b != 0) {
    const Shares first = area_beside(0, a / 2.0, middle, 0, left),
                 second = area_beside(middle, 0, length, b / 2.0, left);
    const double plain = std::min(length / 32, 1.0);
    for (std::size_t i = 0; i < 2; ++i)
      for (const double v : {first[i], second[i]}) out[i] += std::sqrt(2 * v) / 2 * (1 - plain) + v * plain;
  } else if (a != 0 && left <= right) {
    out = area_beside(0, a / 2.0, middle, 0, left);
  } else if (b != 0 && left >= right) {
    out = area_beside(middle, 0, length, b / 2.0, left);
  }
  const double share = (1 - s.corner_rounding / 100) / ((left <= right) + (right <= left));
  const double at_start = left <= right ? share : 0, at_end = right <= left ? share : 0;
  out[0] *= std::clamp(1 - at_start * map.side(start, y + 1) - at_end * map.side(end, y + 1), 0.0, 1.0);
  out[1] *= std::clamp(1 - at_start * map.side(start, y - 2) - at_end * map.side(end, y - 2), 0.0, 1.0);
  return out;
}

}  // namespace

DoubleImage smaa_edges(const DoubleImage& source, const Smaa& s) {
  DoubleImage luma = generate(source.size(), [&](int x, int y) { return Rgba(smaa_luma(source.at(x, y))); });
  const auto change = [&](int x, int y, int dx, int dy) {
    return std::abs(luma.clamped(x, y).r - luma.clamped(x + dx, y + dy).r);
  };
  return generate(source.size(), [&](int x, int y) {
    const double left = change(x, y, -1, 0), top = change(x, y, 0, -1);
    double most = std::max({left, top, change(x, y, 1, 0), change(x, y, 0, 1)});
    most = std::max({most, std::abs(luma.clamped(x - 1, y).r - luma.clamped(x - 2, y).r),
                     std::abs(luma.clamped(x, y - 1).r - luma.clamped(x, y - 2).r)});
    const auto edge = [&](double c) { return c >= s.threshold && 2 * c >= most ? 1.0 : 0.0; };
    return Rgba(edge(left), edge(top), 0, 0);
  });
}

DoubleImage smaa_weights(const DoubleImage& edges, const Smaa& s) {
  return generate(edges.size(), [&](int x, int y) {
    Rgba out(0);
    if (edges.at(x, y).g > 0) {
      const Shares shares = edge_shares({edges, false}, x, y, s);
      out.r = shares[0], out.g = shares[1];
    }
    if (edges.at(x, y).r > 0) {
      const Shares shares = edge_shares({edges, true}, y, x, s);
      out.b = shares[0], out.a = shares[1];
    }
    return out;
  });
}

DoubleImage smaa(const DoubleImage& source, const Smaa& s) {
  const DoubleImage weights = smaa_weights(smaa_edges(source, s), s);
  return generate(source.size(), [&](int x, int y) {
    const Rgba& p = source.at(x, y);
    const double above = weights.at(x, y).r, left = weights.at(x, y).b;
    const double below = y + 1 < source.height ? weights.at(x, y + 1).g : 0;
    const double right = x + 1 < source.width ? weights.at(x + 1, y).a : 0;
    const bool level = std::max(left, right) > std::max(above, below) + 1e-5;
    const double ahead = level ? right : below, behind = level ? left : above;
    if (ahead + behind <= 0) return p;
    const Rgb next(source.clamped(x + level, y + !level)), last(source.clamped(x - level, y - !level));
    const Rgb mixed = glm::mix(Rgb(p), next, ahead) * ahead + glm::mix(Rgb(p), last, behind) * behind;
    return Rgba(mixed / (ahead + behind), p.a);
  });
}

}  // namespace afterglow::reference
