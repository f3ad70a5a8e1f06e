// SPDX-License-Identifier: MIT
#include "reference/color.h"

#include <cmath>

namespace afterglow::reference {

namespace {

// Alexa LogC El 1000.
constexpr double kLogcA = 5.555556, kLogcB = 0.047996, kLogcC = 0.244161, kLogcD = 0.386036;

}  // namespace

double luminance(const Rgb& c) { return 0.2126729 * c.r + 0.7151522 * c.g + 0.0721750 * c.b; }

double srgb_to_linear(double c) { return c <= 0.04045 ? c / 12.92 : std::pow(std::abs((c + 0.055) / 1.055), 2.4); }

double linear_to_srgb(double c) { return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(std::abs(c), 1 / 2.4) - 0.055; }

double gamma_to_linear(double v) {
  if (v <= 0.04045) return v / 12.92;
  if (v < 1) return std::pow((v + 0.055) / 1.055, 2.4);
  return std::pow(v, 2.2);
}

double linear_to_logc(double x) { return kLogcC * std::log10(glm::max(kLogcA * x + kLogcB, 0.0)) + kLogcD; }

double logc_to_linear(double y) { return (std::pow(10.0, (y - kLogcD) / kLogcC) - kLogcB) / kLogcA; }

Rgb rgb_to_hsv(const Rgb& c, double epsilon) {
  const bool green_first = c.g >= c.b;
  const double a = green_first ? c.g : c.b, b = green_first ? c.b : c.g;
  const double k0 = green_first ? 0.0 : -1.0, k1 = green_first ? -1.0 / 3 : 2.0 / 3;
  const bool red_first = c.r >= a;
  const double value = red_first ? c.r : a, other = red_first ? a : c.r, k = red_first ? k0 : k1;
  const double d = value - glm::min(other, b);
  return {std::abs(k + (other - b) / (6 * d + epsilon)), d / (value + epsilon), value};
}

Rgb hsv_to_rgb(const Rgb& hsv) {
  Rgb out;
  for (int i = 0; i < 3; ++i) {
    const double k = 1 - i / 3.0;
    const double turned = hsv.x + k;
    const double q = std::abs((turned - std::floor(turned)) * 6 - 3);
    out[i] = hsv.z * (1 + hsv.y * (saturate(q - 1) - 1));
  }
  return out;
}

double rotate_hue(double h) {
  if (h < 0) return h + 1;
  if (h > 1) return h - 1;
  return h;
}

}  // namespace afterglow::reference
