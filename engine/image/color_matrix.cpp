// SPDX-License-Identifier: MIT
#include "image/color_matrix.h"

#include <cmath>

namespace afterglow {
namespace {

using Vector3 = std::array<double, 3>;

Vector3 transform(const Matrix3& m, const Vector3& v) {
  Vector3 out{};
  for (int i = 0; i < 3; ++i) out[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
  return out;
}

/// XYZ of a chromaticity at Y = 1.
Vector3 xyz_of(const std::array<double, 2>& xy) { return {xy[0] / xy[1], 1, (1 - xy[0] - xy[1]) / xy[1]}; }

constexpr Matrix3 kBradford{{{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}};
constexpr std::array<double, 2> kD50{0.34567, 0.35850};

}  // namespace

Matrix3 multiply(const Matrix3& a, const Matrix3& b) {
  Matrix3 out{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) out[i][j] += a[i][k] * b[k][j];
  return out;
}

Matrix3 inverse(const Matrix3& m) {
  const auto minor = [&](int r0, int r1, int c0, int c1) { return m[r0][c0] * m[r1][c1] - m[r0][c1] * m[r1][c0]; };
  const double determinant = m[0][0] * minor(1, 2, 1, 2) - m[0][1] * minor(1, 2, 0, 2) + m[0][2] * minor(1, 2, 0, 1);
  if (!(std::abs(determinant) > 1e-12)) return {};
  Matrix3 out{{{minor(1, 2, 1, 2), -minor(0, 2, 1, 2), minor(0, 1, 1, 2)},
               {-minor(1, 2, 0, 2), minor(0, 2, 0, 2), -minor(0, 1, 0, 2)},
               {minor(1, 2, 0, 1), -minor(0, 2, 0, 1), minor(0, 1, 0, 1)}}};
  for (auto& row : out)
    for (double& value : row) value /= determinant;
  return out;
}

Matrix3 rgb_to_xyz(const Chromaticities& p) {
  for (const auto& xy : {p.red, p.green, p.blue, p.white})
    if (!std::isfinite(xy[0]) || !std::isfinite(xy[1])) return {};
  if (!(std::abs(p.white[1]) > 1e-6)) return {};
  // Columns are x, y, z of the primaries (blue of AP0 has a y below 0), scaled so that they add up to white.
  const auto column = [](const std::array<double, 2>& xy) { return Vector3{xy[0], xy[1], 1 - xy[0] - xy[1]}; };
  const Vector3 r = column(p.red), g = column(p.green), b = column(p.blue);
  Matrix3 m{};
  for (int i = 0; i < 3; ++i) m[i] = {r[i], g[i], b[i]};
  const Vector3 scale = transform(inverse(m), xyz_of(p.white));
  for (auto& row : m)
    for (int j = 0; j < 3; ++j) row[j] *= scale[j];
  return m;
}

Matrix3 adapt_white(const std::array<double, 2>& from, const std::array<double, 2>& to) {
  const Vector3 source = transform(kBradford, xyz_of(from)), target = transform(kBradford, xyz_of(to));
  Matrix3 gain{};
  for (int i = 0; i < 3; ++i) gain[i][i] = target[i] / source[i];
  return multiply(inverse(kBradford), multiply(gain, kBradford));
}

Matrix3 to_rec709(const Chromaticities& primaries) {
  const Matrix3 to_xyz = rgb_to_xyz(primaries);
  const Matrix3 check = inverse(to_xyz);
  if (check == Matrix3{}) return {};
  // XYZ itself: its white of equal energy is where the axes are, not the light that the scene was seen under.
  if (nearly_equal(to_xyz, kIdentity, 1e-3)) return inverse(rgb_to_xyz(kRec709));
  return multiply(inverse(rgb_to_xyz(kRec709)), multiply(adapt_white(primaries.white, kRec709.white), to_xyz));
}

Matrix3 xyz_d50_to_rec709() { return multiply(inverse(rgb_to_xyz(kRec709)), adapt_white(kD50, kRec709.white)); }

bool nearly_equal(const Matrix3& a, const Matrix3& b, double tolerance) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (!(std::abs(a[i][j] - b[i][j]) <= tolerance)) return false;
  return true;
}

}  // namespace afterglow
