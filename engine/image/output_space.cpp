// SPDX-License-Identifier: MIT
#include "image/output_space.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <mutex>

namespace afterglow {
namespace {

constexpr int kMantissaBits = 7, kShift = 23 - kMantissaBits;  // parts of an octave
constexpr float kSmallest = 0x1p-40f, kLargest = 0x1p10f;      // the brightest that a space holds is below
constexpr std::uint32_t kMask = (1u << kShift) - 1;

std::uint32_t part_of(float light) { return std::bit_cast<std::uint32_t>(light) >> kShift; }

/// The stored value of this light; the curves rise. Above 1 the curve goes on straight, so that lines between two of
/// the table are right up to its end.
double inverse_of(double (*to_linear)(double), double light) {
  constexpr double kStep = 1e-4;
  double low = 0, high = 1;
  if (const double most = to_linear(high); most <= light)
    return std::min(high + (light - most) * kStep / (most - to_linear(high - kStep)), 2.0);
  if (to_linear(low) >= light) return low;
  for (int i = 0; i < 50; ++i) {
    const double middle = (low + high) / 2;
    (to_linear(middle) <= light ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace

OutputSpace::OutputSpace(const InputSpace& space) : name_(space.name) {
  of_zero_ = static_cast<float>(inverse_of(space.to_linear, 0));
  for (std::uint32_t part = part_of(kSmallest); part <= part_of(kLargest); ++part)
    table_.push_back(
        static_cast<float>(inverse_of(space.to_linear, static_cast<double>(std::bit_cast<float>(part << kShift)))));
  const Matrix3 matrix = inverse(to_rec709(space.primaries));
  if (!nearly_equal(matrix, kIdentity, 1e-6)) matrix_ = matrix;
}

const OutputSpace& OutputSpace::of(const InputSpace& space) {
  static std::mutex mutex;
  static std::array<std::unique_ptr<const OutputSpace>, 32> made;
  const auto index = static_cast<std::size_t>(&space - input_spaces().data());
  const std::lock_guard lock(mutex);
  auto& one = made.at(index);
  if (!one) one.reset(new OutputSpace(space));
  return *one;
}

float OutputSpace::stored(float light) const {
  if (!(light > kSmallest)) return light > 0 ? of_zero_ + (table_.front() - of_zero_) * (light / kSmallest) : of_zero_;
  if (light >= kLargest) return 1;
  const std::size_t part = part_of(light) - part_of(kSmallest);
  const float t = static_cast<float>(std::bit_cast<std::uint32_t>(light) & kMask) * (1.0f / (kMask + 1));
  return std::min(table_[part] + (table_[part + 1] - table_[part]) * t, 1.0f);
}

void OutputSpace::encode(float* rgba, std::size_t pixels) const {
  for (std::size_t i = 0; i < pixels; ++i, rgba += 4) {
    if (matrix_) {
      const Matrix3& m = *matrix_;
      const double r = rgba[0], g = rgba[1], b = rgba[2];
      for (std::size_t c = 0; c < 3; ++c) rgba[c] = static_cast<float>(m[c][0] * r + m[c][1] * g + m[c][2] * b);
    }
    for (int c = 0; c < 3; ++c) rgba[c] = stored(rgba[c]);
  }
}

Result<const OutputSpace*> find_output_space(const std::string& name) {
  if (name.empty()) return nullptr;
  const auto space = find_input_space(name);
  if (space) return &OutputSpace::of(**space);
  Error error = space.error();
  error.message = "'" + name + "' is no output space";
  return error;
}

}  // namespace afterglow
