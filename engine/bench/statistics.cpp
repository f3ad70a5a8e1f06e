// SPDX-License-Identifier: MIT
#include "bench/statistics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace afterglow::bench {

double quantile(const std::vector<double>& sorted, double part) {
  const double at = part * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(std::floor(at));
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - std::floor(at)) * (sorted[above] - sorted[below]);
}

Spread Spread::of(std::vector<double> samples) {
  Spread out;
  if (samples.empty()) return out;
  std::vector<double> sorted = samples;
  std::ranges::sort(sorted);
  out.median = quantile(sorted, 0.5);
  out.lower = quantile(sorted, 0.25);
  out.upper = quantile(sorted, 0.75);
  out.samples = std::move(samples);
  return out;
}

}  // namespace afterglow::bench
