// SPDX-License-Identifier: MIT
// Reports made by hand.
#pragma once

#include "bench/results.h"

namespace afterglow::bench::test {

/// A point with a median time and a 99.99th percentile of the error.
inline Point point(const std::string& choice, double milliseconds, double error) {
  Point p{.choice = choice, .label = choice, .settings = {}};
  p.execute = Spread::of({milliseconds, milliseconds * 0.9, milliseconds * 1.2});
  p.quality =
      Quality{.error = {.worst = 2 * error, .percentile = error, .rms = error / 2}, .psnr = 90, .visible = 0.25};
  p.passes = {{"glow.up+</script>", 1.5}};
  return p;
}

inline Report report(std::vector<Point> points) {
  Report out{
      .version = "1.2", .device = "Card \"1\"", .driver = "d", .kind = "cpu", .repeat = 3, .cells = {}, .goals = {}};
  Cell cell{.preset = "look", .size = {640, 360}, .truth = "double precision"};
  cell.copy = Spread::of({2});
  cell.memory = Spread::of({1});
  cell.points = std::move(points);
  mark_front(cell);
  out.cells.push_back(std::move(cell));
  return out;
}

}  // namespace afterglow::bench::test
