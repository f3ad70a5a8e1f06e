// SPDX-License-Identifier: MIT
#include "bench/quality.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "image/metrics.h"
#include "image/srgb.h"

namespace afterglow::bench {
namespace {

/// Yee's measure takes seconds for larger pictures and says the same.
constexpr long long kMostPixelsForYee = 1 << 21;

double display(double linear) {
  if (!(linear > 0)) return 0;
  return linear >= 1 ? 1 : linear_to_srgb(linear);
}

}  // namespace

double display_psnr(std::span<const float> result, std::span<const double> truth) {
  double sum = 0;
  for (std::size_t i = 0; i < result.size(); ++i) {
    const double difference = display(static_cast<double>(result[i])) - display(truth[i]);
    sum += difference * difference;
  }
  if (sum == 0) return std::numeric_limits<double>::infinity();
  return 10 * std::log10(static_cast<double>(result.size()) / sum);
}

Quality compare_pictures(std::span<const float> result, std::span<const double> truth, Size size, bool visible) {
  Quality out{.error = measure_error(result, truth), .psnr = display_psnr(result, truth), .visible = {}};
  if (!visible || size.area() > kMostPixelsForYee) return out;
  const auto as_displayed = [&](const auto& values) {
    Image image(size.width, size.height, 3);
    std::ranges::transform(values, image.pixels.begin(),
                           [](auto v) { return std::clamp(static_cast<float>(v), 0.0f, 1.0f); });
    return image;
  };
  if (const auto share = visible_difference(as_displayed(result), as_displayed(truth))) out.visible = *share;
  return out;
}

}  // namespace afterglow::bench
