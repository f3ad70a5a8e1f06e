// SPDX-License-Identifier: MIT
#include "stress/truth.h"

#include <algorithm>
#include <exception>

#include "bench/oracle.h"
#include "core/half.h"
#include "stress/pictures.h"

namespace afterglow::stress {
std::optional<std::vector<double>> truth_of(const LookFacts& facts, const Picture& picture, double frame) {
  if (!reference::effect_without_oracle(facts.entries).empty()) return std::nullopt;
  try {
    return bench::oracle_result(picture, facts.entries, frame);
  } catch (const std::exception&) {  // an effect of the user's that has the name of another, with settings of its own
    return std::nullopt;
  }
}

ErrorMeasure error_against(const Image& image, std::vector<double> truth, bool half) {
  std::vector<float> rgb;
  rgb.reserve(truth.size());
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    if (i % 4 < 3) rgb.push_back(image.pixels[i]);
  const double largest = half ? static_cast<double>(kMaxHalf) : static_cast<double>(kLargestColor);
  for (double& v : truth) v = std::clamp(v, -largest, largest);
  return measure_error(rgb, std::span<const double>(truth));
}

bool exact_in_halves(const Image& rgba) {
  Image rounded = rgba;
  round_to_halves(rounded);
  return rounded.pixels == rgba.pixels;
}

}  // namespace afterglow::stress
