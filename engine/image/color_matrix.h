// SPDX-License-Identifier: MIT
// Colour primaries as 3×3 matrices.
#pragma once

#include <array>
#include <cstddef>

namespace afterglow {

using Matrix3 = std::array<std::array<double, 3>, 3>;  ///< rows

struct Chromaticities {
  std::array<double, 2> red, green, blue, white;  ///< CIE x, y
  bool operator==(const Chromaticities&) const = default;
};
inline constexpr Chromaticities kRec709{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}};

Matrix3 multiply(const Matrix3& a, const Matrix3& b);
/// Of a colour; `to` may be `from`.
inline void multiply(const Matrix3& m, const float* from, float* to) {
  const double r = from[0], g = from[1], b = from[2];
  for (std::size_t c = 0; c < 3; ++c) to[c] = static_cast<float>(m[c][0] * r + m[c][1] * g + m[c][2] * b);
}
/// All zero when `m` cannot be inverted.
Matrix3 inverse(const Matrix3& m);

/// Linear RGB of these primaries to CIE XYZ, white at Y = 1. All zero for primaries that span no triangle.
Matrix3 rgb_to_xyz(const Chromaticities& primaries);
/// XYZ seen under white `from` to XYZ seen under white `to`, both as x, y (Bradford).
Matrix3 adapt_white(const std::array<double, 2>& from, const std::array<double, 2>& to);

/// Linear RGB of these primaries to linear Rec.709, white to D65; CIE XYZ as it is, without adaptation. All zero for
/// primaries that make no sense.
Matrix3 to_rec709(const Chromaticities& primaries);
/// XYZ under D50 (the connection space of ICC profiles) to linear Rec.709.
Matrix3 xyz_d50_to_rec709();

bool nearly_equal(const Matrix3& a, const Matrix3& b, double tolerance);
inline constexpr Matrix3 kIdentity{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

}  // namespace afterglow
