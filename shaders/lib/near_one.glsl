// SPDX-License-Identifier: MIT
// What is left of 1: logarithms of numbers near 1 and powers that differ little from 1, with the digits of the difference.

/// log(1 + x), x > −1.
vec3 log_of_one_plus(vec3 x) {
  vec3 z = x / (2.0 + x), q = z * z;
  vec3 series = 2.0 * z * (1.0 + q * (1.0 / 3.0 + q * (1.0 / 5.0 + q * (1.0 / 7.0))));
  return mix(log(max(1.0 + x, 1e-37)), series, lessThan(abs(x), vec3(0.25)));
}

/// 1 − exp(u), u ≤ 0.
vec3 one_minus_exp(vec3 u) {
  vec3 series = -u * (1.0 + u * (1.0 / 2.0) * (1.0 + u * (1.0 / 3.0) * (1.0 + u * (1.0 / 4.0) * (1.0 + u * (1.0 / 5.0) * (1.0 + u * (1.0 / 6.0))))));
  return mix(1.0 - exp(u), series, greaterThan(u, vec3(-0.3)));
}
