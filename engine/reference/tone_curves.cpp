// SPDX-License-Identifier: MIT
// The newer tone curves (docs/math.md §21), each in the steps in which its author published it.
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include "reference/color.h"
#include "reference/tone_mapping.h"

namespace afterglow::reference {
namespace {

glm::dmat3 from_rows(const Rgb& a, const Rgb& b, const Rgb& c) { return glm::transpose(glm::dmat3(a, b, c)); }

struct Chromaticity {
  double x, y;
};

/// Linear RGB of these primaries to CIE XYZ; D65 white.
glm::dmat3 to_xyz(const std::array<Chromaticity, 3>& primaries) {
  const auto xyz = [](const Chromaticity& c) { return Rgb(c.x / c.y, 1, (1 - c.x - c.y) / c.y); };
  const glm::dmat3 columns(xyz(primaries[0]), xyz(primaries[1]), xyz(primaries[2]));
  const Rgb scale = glm::inverse(columns) * xyz({0.3127, 0.3290});
  return {columns[0] * scale.r, columns[1] * scale.g, columns[2] * scale.b};
}

const glm::dmat3& rec2020_from_rec709() {
  static const glm::dmat3 matrix = glm::inverse(to_xyz({{{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}}})) *
                                   to_xyz({{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}}});
  return matrix;
}

/// Sobotka's equation_scale and equation_full_curve.
double sigmoid_scale(double x_pivot, double y_pivot, double slope, double power) {
  return std::pow(std::pow(slope * x_pivot, -power) * (std::pow(slope * (x_pivot / y_pivot), power) - 1), -1 / power);
}

double sigmoid(double x) {
  constexpr double kXPivot = 10.0 / 16.5, kYPivot = 0.5, kSlope = 2;
  const bool above = x >= kXPivot;
  const double power = above ? 3.25 : 3.0;
  const double scale =
      above ? sigmoid_scale(1 - kXPivot, 1 - kYPivot, kSlope, power) : -sigmoid_scale(kXPivot, kYPivot, kSlope, power);
  const double term = kSlope * (x - kXPivot) / scale;
  return scale * term / std::pow(1 + std::pow(term, power), 1 / power) + kYPivot;
}

Rgb cdl_of(const Rgb& c, const Rgb& slope, double power, double saturation) {
  const double luma = glm::dot(c, Rgb(0.2126, 0.7152, 0.0722));
  return luma + saturation * (glm::pow(c * slope, Rgb(power)) - luma);
}

/// A segment of Hable's curve: y = scale·exp(ln A + B·ln((x − offset)·scale)) + offset.
struct Segment {
  double offset_x = 0, offset_y = 0, scale_x = 1, scale_y = 1, ln_a = 0, b = 1;
  double operator()(double x) const {
    const double from = (x - offset_x) * scale_x;
    return (from > 0 ? std::exp(ln_a + b * std::log(from)) : 0.0) * scale_y + offset_y;
  }
  /// Through (x, y) with slope m, and through 0.
  void solve(double x, double y, double m) {
    b = m * x / y;
    ln_a = std::log(y) - b * std::log(x);
  }
};

/// FilmicToneCurve with gamma 1, from user parameters; strength of the shoulder such that `white` is its W.
class HableCurve {
 public:
  explicit HableCurve(const ToneMapping& s) {
    const double toe_length = std::pow(s.toe_length, 2.2), shoulder_length = std::max(1e-5, s.shoulder_length);
    x0_ = toe_length * 0.5;
    double y0 = (1 - s.toe) * x0_;
    const double remaining = 1 - y0, least = x0_ + remaining;
    x1_ = x0_ + (1 - shoulder_length) * remaining;
    double y1 = y0 + (1 - shoulder_length) * remaining;
    white_ = std::max(s.white, least);
    const double strength = std::log2(white_ - least + 1);
    const double overshoot_x = white_ * 2 * s.shoulder_angle * strength / white_;
    const double overshoot_y = 0.5 * s.shoulder_angle * strength;
    x0_ /= white_;
    x1_ /= white_;
    const double m = white_;  // (y1 − y0)/(x1 − x0), also where both are 0
    middle_.offset_x = -(y0 - x0_ * m) / m;
    middle_.ln_a = std::log(m);
    y0 = std::max(1e-5, y0);
    y1 = std::max(1e-5, y1);
    if (x0_ > 0) toe_.solve(x0_, y0, m);
    shoulder_.solve(1 + overshoot_x - x1_, 1 + overshoot_y - y1, m);
    shoulder_.offset_x = 1 + overshoot_x;
    shoulder_.offset_y = 1 + overshoot_y;
    shoulder_.scale_x = shoulder_.scale_y = -1;
    scale_ = 1 / shoulder_(1);
  }
  double operator()(double light) const {
    const double x = light / white_;
    return scale_ * (x < x0_ ? toe_(x) : x < x1_ ? middle_(x) : shoulder_(x));
  }

 private:
  double x0_ = 0, x1_ = 0, white_ = 1, scale_ = 1;
  Segment toe_, middle_, shoulder_;
};

double gt(double x) {
  constexpr double P = 1, a = 1, m = 0.22, l = 0.4, c = 1.33, b = 0;
  constexpr double l0 = (P - m) * l / a, S0 = m + l0, S1 = m + a * l0, C2 = a * P / (P - S1);
  const double w0 = 1 - glm::smoothstep(0.0, m, x), w2 = x < m + l0 ? 0 : 1, w1 = 1 - w0 - w2;
  const double T = m * std::pow(x / m, c) + b, L = m + a * (x - m), S = P - (P - S1) * std::exp(-C2 * (x - S0) / P);
  return T * w0 + L * w1 + S * w2;
}

}  // namespace

Rgb tone_reinhard_extended(const Rgb& x, double white) {
  const double y = luminance(x);
  return y > 0 ? x * (y * (1 + y / (white * white)) / (1 + y) / y) : x;
}

Rgb tone_agx(const Rgb& x, AgxLook look) {
  const auto inset = from_rows({0.856627153315983, 0.0951212405381588, 0.0482516061458583},
                               {0.137318972929847, 0.761241990602591, 0.101439036467562},
                               {0.11189821299995, 0.0767994186031903, 0.811302368396859});
  const auto outset = from_rows({1.1271005818144368, -0.11060664309660323, -0.016493938717834573},
                                {-0.1413297634984383, 1.157823702216272, -0.016493938717834257},
                                {-0.14132976349843826, -0.11060664309660294, 1.2519364065950405});
  Rgb c = inset * (rec2020_from_rec709() * x);
  for (int i = 0; i < 3; ++i)
    c[i] = sigmoid(glm::clamp((std::log2(std::max(c[i], 1e-10) / 0.18) + 10) / 16.5, 0.0, 1.0));
  c = glm::max(c, Rgb(0));
  if (look == AgxLook::punchy) c = cdl_of(c, Rgb(1), 1.35, 1.4);
  if (look == AgxLook::golden) c = cdl_of(c, Rgb(1, 0.9, 0.5), 0.8, 0.8);
  c = glm::pow(glm::max(outset * c, Rgb(0)), Rgb(2.2));
  return glm::clamp(glm::inverse(rec2020_from_rec709()) * c, Rgb(0), Rgb(1));
}

Rgb tone_khronos_neutral(const Rgb& x) {
  const double start = 0.8 - 0.04, least = std::min({x.r, x.g, x.b});
  const Rgb c = x - (least < 0.08 ? least - 6.25 * least * least : 0.04);
  const double peak = std::max({c.r, c.g, c.b});
  if (peak < start) return c;
  const double room = 1 - start, held = 1 - room * room / (peak + room - start);
  const double g = 1 - 1 / (0.15 * (peak - held) + 1);
  return glm::mix(c * (held / peak), Rgb(held), g);
}

Rgb tone_hable(const Rgb& x, const ToneMapping& settings) {
  const HableCurve curve(settings);
  return {curve(x.r), curve(x.g), curve(x.b)};
}

Rgb tone_gt(const Rgb& x) { return {gt(x.r), gt(x.g), gt(x.b)}; }

}  // namespace afterglow::reference
