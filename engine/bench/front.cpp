// SPDX-License-Identifier: MIT
#include <algorithm>

#include "bench/results.h"

namespace afterglow::bench {
namespace {

bool beats(const Point& a, const Point& b) {
  const double time_a = a.execute.median, time_b = b.execute.median;
  const double error_a = a.quality->error.percentile, error_b = b.quality->error.percentile;
  return time_a <= time_b && error_a <= error_b && (time_a < time_b || error_a < error_b);
}

}  // namespace

void mark_front(Cell& cell) {
  for (auto& point : cell.points) {
    point.front = point.quality && std::ranges::none_of(cell.points, [&](const Point& other) {
                    return other.quality && beats(other, point);
                  });
  }
}

}  // namespace afterglow::bench
