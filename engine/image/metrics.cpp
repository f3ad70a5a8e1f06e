// SPDX-License-Identifier: MIT
#include "image/metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace afterglow {
namespace {

constexpr double kFloor = 0.01;  // math.md §13: keeps the measure meaningful near black
constexpr double kPercentile = 0.9999;
constexpr double kWorstAllowance = 50.0;  // the worst sample may be this many tolerances off

template <class Reference, class Sizes>
ErrorMeasure measure(std::span<const float> x, std::span<const Reference> reference, std::span<const Sizes> sizes) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  ErrorMeasure result;
  if (x.size() != reference.size() || x.size() != sizes.size()) {
    result.worst = result.percentile = result.rms = kInfinity;
    result.worst_index = std::min(x.size(), reference.size());
    return result;
  }
  if (x.empty()) return result;
  std::vector<float> errors(x.size());
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double value = x[i], wanted = static_cast<double>(reference[i]);
    double error = kInfinity;
    if (!std::isfinite(value)) {
      ++result.non_finite;
    } else if (std::isfinite(wanted)) {
      error = std::abs(value - wanted) / (std::abs(static_cast<double>(sizes[i])) + kFloor);
    }
    if (error > result.worst) {
      result.worst = error;
      result.worst_index = i;
    }
    sum += error * error;
    errors[i] = static_cast<float>(error);
  }
  // Nearest rank: the smallest error that at least 99.99 % of the samples do not exceed.
  const auto rank = static_cast<std::size_t>(std::ceil(kPercentile * static_cast<double>(x.size())));
  const auto nth = errors.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1) - 1);
  std::nth_element(errors.begin(), nth, errors.end());
  result.percentile = *nth;
  result.rms = std::sqrt(sum / static_cast<double>(x.size()));
  return result;
}

}  // namespace

ErrorMeasure measure_error(std::span<const float> x, std::span<const double> reference) {
  return measure(x, reference, reference);
}
ErrorMeasure measure_error(std::span<const float> x, std::span<const float> reference) {
  return measure(x, reference, reference);
}
ErrorMeasure measure_error(std::span<const float> x, std::span<const float> reference, std::span<const float> sizes) {
  return measure(x, reference, sizes);
}

bool within(const ErrorMeasure& error, double tolerance) {
  return error.percentile <= tolerance && error.worst <= kWorstAllowance * tolerance;
}

}  // namespace afterglow
