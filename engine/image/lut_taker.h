// SPDX-License-Identifier: MIT
// A chain of OpenColorIO's transforms taken apart into steps that a shader can do. For the module with OpenColorIO
// alone.
#pragma once

#include <OpenColorIO/OpenColorIO.h>

#include <array>
#include <string>
#include <vector>

#include "image/lut_file.h"
#include "image/ocio_module.h"

namespace afterglow {

namespace OCIO = OCIO_NAMESPACE;

/// Turns transforms into steps, in order. Matrices, ranges, tables, CDLs and exponents are steps of their own; whatever
/// else treats each channel by itself becomes a table over half floats, made by OpenColorIO's own processor. Throws
/// Unsupported.
class LutTaker {
 public:
  explicit LutTaker(OCIO::ConstConfigRcPtr config) : config_(std::move(config)) {}
  Lut take(const OCIO::GroupTransform& group);

 private:
  using Row = std::vector<std::array<float, 4>>;
  struct Placed {
    int x, y;
    std::array<float, 4> value;
  };

  void begin(LutKind kind, int size, int rows);
  void put(int x, int y, const std::array<float, 4>& v) { placed_.push_back({x, first_ + y, v}); }
  Lut finish();
  void add_group(const OCIO::GroupTransform& group);
  void add(const OCIO::Transform& transform);
  bool add_known(const OCIO::Transform& transform);
  bool add_matrix(const OCIO::MatrixTransform& matrix);
  bool add_range(const OCIO::RangeTransform& range);
  bool add_table(const OCIO::Lut1DTransform& table);
  bool add_table(const OCIO::Lut3DTransform& table);
  bool add_cdl(const OCIO::CDLTransform& cdl);
  bool add_power(const OCIO::ExponentTransform& power);
  void add_curve(const OCIO::Transform& transform);
  void put(const Row& row) {
    for (std::size_t i = 0; i < row.size(); ++i) put(static_cast<int>(i), 0, row[i]);
  }

  OCIO::ConstConfigRcPtr config_;
  Lut lut_;
  std::vector<Placed> placed_;
  int rows_ = 0, first_ = 0;
};

}  // namespace afterglow
