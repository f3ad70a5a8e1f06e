// SPDX-License-Identifier: MIT
// Tangents to 1e-7 on every device: Vulkan allows its own `tan` and `atan` 4096 units in the last place, and some take them. Polynomials of
// M. Abramowitz, I. Stegun, "Handbook of Mathematical Functions", 4.3.101 and 4.4.49.

/// tan x for 0 ≤ x; angles from a right one on give 1e6.
float tangent(float x) {
  const float kHalfPi = 1.57079632679;
  float rest = max((kHalfPi - x) - 4.371139e-8, 1e-6);  // the constant's rounding
  bool steep = x > 0.5 * kHalfPi;
  float a = steep ? rest : x, z = a * a;
  float t = a + a * z * (0.3333314036 + z * (0.1333923995 + z * (0.0533740603 + z * (0.0245650893 + z * (0.0029005250 + z * 0.0095168091)))));
  return steep ? 1.0 / t : t;
}

/// atan x for 0 ≤ x.
float arc_tangent(float x) {
  bool steep = x > 1.0;
  float a = steep ? 1.0 / x : x, z = a * a;
  float series = -0.3333314528 + z * (0.1999355085 + z * (-0.1420889944 + z * (0.1065626393 + z * (-0.0752896400 + z * (0.0429096138 +
                 z * (-0.0161657367 + z * 0.0028662257))))));
  float t = a + a * z * series;
  return steep ? 1.57079632679 - t : t;
}
