// SPDX-License-Identifier: MIT
#include "image/lut_taker.h"

#include <fmt/format.h>
#include <half.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace afterglow {
namespace {

constexpr float kHuge = std::numeric_limits<float>::max();
constexpr float kLargestHalf = 65504.0F;

}  // namespace

Lut LutTaker::take(const OCIO::GroupTransform& group) {
  add_group(group);
  return finish();
}

void LutTaker::add_group(const OCIO::GroupTransform& group) {
  for (int i = 0; i < group.getNumTransforms(); ++i) add(*group.getTransform(i));
}

void LutTaker::add(const OCIO::Transform& transform) {
  if (const auto* group = dynamic_cast<const OCIO::GroupTransform*>(&transform)) return add_group(*group);
  if (!add_known(transform)) add_curve(transform);
}

// False: not one of these, or not in the direction that a step has.
bool LutTaker::add_known(const OCIO::Transform& transform) {
  if (const auto* matrix = dynamic_cast<const OCIO::MatrixTransform*>(&transform)) return add_matrix(*matrix);
  if (const auto* power = dynamic_cast<const OCIO::ExponentTransform*>(&transform)) return add_power(*power);
  if (transform.getDirection() != OCIO::TRANSFORM_DIR_FORWARD) return false;
  if (const auto* range = dynamic_cast<const OCIO::RangeTransform*>(&transform)) return add_range(*range);
  if (const auto* table = dynamic_cast<const OCIO::Lut1DTransform*>(&transform)) return add_table(*table);
  if (const auto* table = dynamic_cast<const OCIO::Lut3DTransform*>(&transform)) return add_table(*table);
  if (const auto* cdl = dynamic_cast<const OCIO::CDLTransform*>(&transform)) return add_cdl(*cdl);
  return false;
}

bool LutTaker::add_matrix(const OCIO::MatrixTransform& matrix) {
  std::array<double, 16> m{};
  std::array<double, 4> offset{};
  if (matrix.getDirection() == OCIO::TRANSFORM_DIR_FORWARD) {
    matrix.getMatrix(m.data());
    matrix.getOffset(offset.data());
  } else {  // what its processor makes of black and of each primary
    const auto processor = config_->getProcessor(matrix.createEditableCopy())->getDefaultCPUProcessor();
    for (std::size_t column = 0; column < 4; ++column) {
      std::array<float, 3> c{};
      if (column < 3) c[column] = 1;
      processor->applyRGB(c.data());
      for (std::size_t row = 0; row < 3; ++row)
        column < 3 ? m[4 * row + column] = double(c[row]) : offset[row] = double(c[row]);
    }
    for (std::size_t row = 0; row < 3; ++row)
      for (std::size_t column = 0; column < 3; ++column) m[4 * row + column] -= offset[row];
  }
  Row row;
  for (std::size_t i = 0; i < 3; ++i)
    row.push_back({static_cast<float>(m[4 * i]), static_cast<float>(m[4 * i + 1]), static_cast<float>(m[4 * i + 2]),
                   static_cast<float>(offset[i])});
  begin(LutKind::matrix, 0, 1);
  put(row);
  return true;
}

bool LutTaker::add_range(const OCIO::RangeTransform& range) {
  const bool low = range.hasMinInValue() && range.hasMinOutValue();
  const bool high = range.hasMaxInValue() && range.hasMaxOutValue();
  double scale = 1, offset = 0;
  if (low && high && range.getMaxInValue() > range.getMinInValue())
    scale = (range.getMaxOutValue() - range.getMinOutValue()) / (range.getMaxInValue() - range.getMinInValue());
  if (low)
    offset = range.getMinOutValue() - scale * range.getMinInValue();
  else if (high)
    offset = range.getMaxOutValue() - scale * range.getMaxInValue();
  const bool clamps = range.getStyle() == OCIO::RANGE_CLAMP;
  begin(LutKind::range, 0, 1);
  put({{static_cast<float>(scale), static_cast<float>(offset),
        clamps && low ? static_cast<float>(range.getMinOutValue()) : -kHuge,
        clamps && high ? static_cast<float>(range.getMaxOutValue()) : kHuge}});
  return true;
}

bool LutTaker::add_table(const OCIO::Lut1DTransform& table) {
  if (table.getHueAdjust() != OCIO::HUE_NONE) throw Unsupported{"holds a table with hue adjustment"};
  const auto length = static_cast<int>(table.getLength());
  begin(table.getInputHalfDomain() ? LutKind::table_half : LutKind::table1d, length, (length + kLutRow - 1) / kLutRow);
  for (int i = 0; i < length; ++i) {
    float r = 0, g = 0, b = 0;
    table.getValue(static_cast<unsigned long>(i), r, g, b);
    put(i % kLutRow, i / kLutRow, {r, g, b, 1});
  }
  return true;
}

bool LutTaker::add_table(const OCIO::Lut3DTransform& table) {
  const auto size = static_cast<int>(table.getGridSize());
  const bool linear = table.getInterpolation() == OCIO::INTERP_LINEAR;  // said by the file: elsewhere it is a default
  begin(linear ? LutKind::table3d_linear : LutKind::table3d, size, size * ((size + 1) / 2));
  for (int r = 0; r < size; ++r)
    for (int g = 0; g < size; ++g)
      for (int b = 0; b < size; ++b) {
        float red = 0, green = 0, blue = 0;
        table.getValue(static_cast<unsigned long>(r), static_cast<unsigned long>(g), static_cast<unsigned long>(b), red,
                       green, blue);
        put(r + size * (b & 1), g + size * (b >> 1), {red, green, blue, 1});
      }
  return true;
}

bool LutTaker::add_cdl(const OCIO::CDLTransform& cdl) {
  std::array<double, 3> v{};
  Row row;
  const auto take = [&] {
    row.push_back({static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]), 0});
  };
  cdl.getSlope(v.data());
  take();
  cdl.getOffset(v.data());
  take();
  cdl.getPower(v.data());
  take();
  row.push_back({static_cast<float>(cdl.getSat()), cdl.getStyle() == OCIO::CDL_ASC ? 1.0F : 0.0F, 0, 0});
  begin(LutKind::cdl, 0, 1);
  put(row);
  return true;
}

bool LutTaker::add_power(const OCIO::ExponentTransform& power) {
  double v[4] = {1, 1, 1, 1};  // NOLINT: OpenColorIO takes an array
  power.getValue(v);
  if (power.getDirection() == OCIO::TRANSFORM_DIR_INVERSE)
    for (double& x : v) x = 1 / x;
  float style = 0;
  if (power.getNegativeStyle() == OCIO::NEGATIVE_MIRROR) style = 1;
  if (power.getNegativeStyle() == OCIO::NEGATIVE_PASS_THRU) style = 2;
  begin(LutKind::power, 0, 1);
  put({{static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]), style}});
  return true;
}

void LutTaker::begin(LutKind kind, int size, int rows) {
  first_ = rows_;
  rows_ += rows;
  if (rows_ > 16384) throw Unsupported{"holds more numbers than an image can have"};
  lut_.steps.push_back({kind, first_, size});
}
Lut LutTaker::finish() {
  if (lut_.steps.size() > static_cast<std::size_t>(kMaxLutSteps))
    throw Unsupported{fmt::format("has {} steps; at most {} are possible", lut_.steps.size(), kMaxLutSteps)};
  int width = 4;
  for (const auto& p : placed_) width = std::max(width, p.x + 1);
  lut_.size = {width, std::max(rows_, 1)};
  lut_.table.assign(static_cast<std::size_t>(lut_.size.area()) * 4, 0.0F);
  for (const auto& p : placed_) {
    for (const float v : p.value)
      if (!std::isfinite(v)) throw Unsupported{"holds a number that is not finite"};
    std::copy(p.value.begin(), p.value.end(),
              lut_.table.begin() + 4 * (static_cast<std::ptrdiff_t>(p.y) * width + p.x));
  }
  return std::move(lut_);
}

// Each channel by itself: a table over half floats, which is as fine as numbers are far from 0.
void LutTaker::add_curve(const OCIO::Transform& transform) {
  const auto processor =
      config_->getProcessor(transform.createEditableCopy())->getOptimizedCPUProcessor(OCIO::OPTIMIZATION_NONE);
  if (processor->hasChannelCrosstalk())
    throw Unsupported{"holds a step that mixes channels and is neither a table, a matrix nor a CDL"};
  begin(LutKind::table_half, 65536, 65536 / kLutRow);
  for (int bits = 0; bits < 65536; ++bits) {
    Imath::half half;
    half.setBits(static_cast<std::uint16_t>(bits));
    const float value = half.isNan() ? 0.0F : std::clamp(static_cast<float>(half), -kLargestHalf, kLargestHalf);
    std::array<float, 3> c{value, value, value};
    processor->applyRGB(c.data());
    put(bits % kLutRow, bits / kLutRow, {c[0], c[1], c[2], 1});
  }
}

}  // namespace afterglow
