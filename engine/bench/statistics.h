// SPDX-License-Identifier: MIT
// The middle and the spread of repeated measurements.
#pragma once

#include <vector>

namespace afterglow::bench {

/// Median and quartiles, interpolated between neighbours; all 0 without samples.
struct Spread {
  double median = 0, lower = 0, upper = 0;
  std::vector<double> samples;  ///< in the order in which they were taken

  static Spread of(std::vector<double> samples);
};

/// The value below which the share `part` (0…1) of the samples lies; `sorted` is ascending and not empty.
double quantile(const std::vector<double>& sorted, double part);

}  // namespace afterglow::bench
