// SPDX-License-Identifier: MIT
#include "reference/tone_mapping.h"

#include <cmath>
#include <numbers>

namespace afterglow::reference {

namespace {

/// Rows as printed in math.md §6.
struct Matrix {
  Rgb rows[3];
  Rgb operator*(const Rgb& v) const { return {glm::dot(rows[0], v), glm::dot(rows[1], v), glm::dot(rows[2], v)}; }
};

constexpr Rgb row(double a, double b, double c) { return Rgb(a, b, c); }

const Matrix kSrgbToAp0{
    {row(0.4397010, 0.3829780, 0.1773350), row(0.0897923, 0.8134230, 0.0967616), row(0.0175440, 0.1115440, 0.8707040)}};
const Matrix kAp0ToAp1{{row(1.4514393161, -0.2365107469, -0.2149285693),
                        row(-0.0765537734, 1.1762296998, -0.0996759264),
                        row(0.0083161484, -0.0060324498, 0.9977163014)}};
const Matrix kAp1ToXyz{{row(0.6624541811, 0.1340042065, 0.1561876870), row(0.2722287168, 0.6740817658, 0.0536895174),
                        row(-0.0055746495, 0.0040607335, 1.0103391003)}};
const Matrix kXyzToAp1{{row(1.6410233797, -0.3248032942, -0.2364246952), row(-0.6636628587, 1.6153315917, 0.0167563477),
                        row(0.0117218943, -0.0082844420, 0.9883948585)}};
const Matrix kXyzToRec709{{row(3.2409699419, -1.5373831776, -0.4986107603),
                           row(-0.9692436363, 1.8759675015, 0.0415550574),
                           row(0.0556300797, -0.2039769589, 1.0569715142)}};
const Matrix kD60ToD65{{row(0.98722400, -0.00611327, 0.0159533), row(-0.00759836, 1.00186000, 0.0053302),
                        row(0.00307257, -0.00509595, 1.0816800)}};
const Rgb kAp1Luma(0.272229, 0.674082, 0.0536895);

Rgb desaturate(const Rgb& x, double amount) {
  const double y = glm::dot(kAp1Luma, x);
  return y + amount * (x - y);
}

/// Factor of the glow, steps 2–4.
double glow_factor(const Rgb& a, double saturation) {
  const double rho = glm::max(a.b * (a.b - a.g) + a.g * (a.g - a.r) + a.r * (a.r - a.b), 0.0);
  const double yc = (a.r + a.g + a.b + 1.75 * std::sqrt(rho)) / 3;
  const double tau = (saturation - 0.4) / 0.2;
  const double q = glm::max(1 - std::abs(tau / 2), 0.0);
  const double s = (1 + (tau >= 0 ? 1 : -1) * (1 - q * q)) / 2;
  const double gain = 0.05 * s;
  if (yc <= 2.0 / 3 * 0.08) return 1 + gain;
  if (yc >= 2 * 0.08) return 1;
  return 1 + gain * (0.08 / yc - 0.5);
}

/// Weight of the red modifier, step 5: 1 at hue 0, 0 from 67.5 degrees on.
double red_weight(const Rgb& a) {
  double hue = 0;
  if (!(a.r == a.g && a.g == a.b)) {
    hue = std::atan2(std::sqrt(3.0) * (a.g - a.b), 2 * a.r - a.g - a.b) * 180 / std::numbers::pi;
    if (hue < 0) hue += 360;
    if (hue > 180) hue -= 360;
  }
  const double u = glm::clamp(1 - std::abs(2 * hue / 135), 0.0, 1.0);
  const double smooth = u * u * (3 - 2 * u);
  return smooth * smooth;
}

/// Step 9: raises luminance to the power 0.9811 at constant chromaticity.
Rgb dim_surround(const Rgb& v) {
  const double sum = glm::max(v.x + v.y + v.z, 1e-4);
  const double xc = v.x / sum, yc = v.y / sum;
  const double y = std::pow(glm::clamp(v.y, 0.0, 65504.0), 0.9811);
  const double m = y / glm::max(yc, 1e-4);
  return {xc * m, y, (1 - xc - yc) * m};
}

}  // namespace

Rgb tone_reinhard(const Rgb& x) { return x / (1.0 + x); }

Rgb tone_neutral(const Rgb& x) {
  constexpr double a = 0.2, b = 0.29, c = 0.24, d = 0.272, e = 0.02, f = 0.3;
  const auto n = [](double v) { return (v * (a * v + c * b) + d * e) / (v * (a * v + b) + d * f) - e / f; };
  const double k = 1 / n(5.3);
  return {k * n(k * x.r), k * n(k * x.g), k * n(k * x.b)};
}

Rgb tone_aces(const Rgb& x) {
  Rgb a = kSrgbToAp0 * x;
  const double mn = glm::min(a.r, glm::min(a.g, a.b)), mx = glm::max(a.r, glm::max(a.g, a.b));
  const double saturation = (glm::max(mx, 1e-4) - glm::max(mn, 1e-4)) / glm::max(mx, 1e-2);
  const double weight = red_weight(a);  // a hue, so the glow's common factor would not change it
  a *= glow_factor(a, saturation);
  a.r += weight * saturation * (0.03 - a.r) * (1 - 0.82);

  Rgb c = desaturate(glm::max(kAp0ToAp1 * a, Rgb(0)), 0.96);
  c = c * (2.785085 * c + 0.107772) / (c * (2.936045 * c + 0.887122) + 0.806889);
  c = desaturate(kXyzToAp1 * dim_surround(kAp1ToXyz * c), 0.93);
  return kXyzToRec709 * (kD60ToD65 * (kAp1ToXyz * c));
}

Rgb tone_map(const Rgb& c, const ToneMapping& s) {
  const Rgb light = c * std::exp2(s.exposure);
  const Rgb x = glm::min(light, Rgb(60)), far = glm::clamp(light, Rgb(0), Rgb(65504));
  switch (s.mode) {
    case ToneMode::none:
      return c;
    case ToneMode::aces:
      return tone_aces(x) / (s.full_white ? tone_aces(Rgb(60)).r : 1.0);
    case ToneMode::neutral:
      return tone_neutral(x);
    case ToneMode::reinhard:
      return tone_reinhard(x) / (s.full_white ? tone_reinhard(Rgb(60)).r : 1.0);
    case ToneMode::reinhard_extended:
      return tone_reinhard_extended(far, s.white);
    case ToneMode::agx:
      return tone_agx(far, s.look);
    case ToneMode::khronos_neutral:
      return tone_khronos_neutral(far);
    case ToneMode::hable:
      return tone_hable(far, s);
    case ToneMode::gt:
      return tone_gt(far);
  }
  return c;
}

Rgb tone_map(const Rgb& c, ToneMode mode) { return tone_map(c, ToneMapping{.mode = mode}); }

DoubleImage tone_mapping(const DoubleImage& source, const ToneMapping& settings) {
  return map_straight(source, [&](const Rgb& c) { return tone_map(c, settings); });
}

DoubleImage tone_mapping(const DoubleImage& source, ToneMode mode) {
  return tone_mapping(source, ToneMapping{.mode = mode});
}

}  // namespace afterglow::reference
