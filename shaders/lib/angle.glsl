// SPDX-License-Identifier: MIT
// Tangents, cosines and sines to 1e-7 on every device: Vulkan allows its own `tan` and `atan` 4096 units in the last place, `cos` and `sin`
// 2^-11 within a turn and anything beyond, and some take them. Polynomials of
// M. Abramowitz, I. Stegun, "Handbook of Mathematical Functions", 4.3.101 and 4.4.49.

/// tan x for 0 ≤ x, of an angle that is exact to 1e-7; angles from a right one on give 1e6.
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

/// Cosine and sine of so many whole turns, to 1e-7 for up to a hundred of them: 4.3.97 and 4.3.99 within an eighth of a turn.
vec2 direction_of(float turns) {
  float quarters = floor(4.0 * turns + 0.5);
  float x = (turns - 0.25 * quarters) * 6.28318530718, z = x * x;
  float s = x + x * z * (-0.1666666664 + z * (0.0083333315 + z * (-0.0001984090 + z * 0.0000027526)));
  float c = 1.0 + z * (-0.4999999963 + z * (0.0416666418 + z * (-0.0013888397 + z * 0.0000247609)));
  int turned = int(quarters) & 3;
  vec2 d = (turned & 1) == 0 ? vec2(c, s) : vec2(-s, c);
  return turned < 2 ? d : -d;
}
