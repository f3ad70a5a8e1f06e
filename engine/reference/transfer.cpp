// SPDX-License-Identifier: MIT
#include "reference/transfer.h"

#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <stdexcept>

#include "reference/color.h"

namespace afterglow::reference {
namespace {

struct Primaries {
  glm::dvec2 red, green, blue, white;
};

constexpr glm::dvec2 kD65{0.3127, 0.3290};
const Primaries kOwn{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, kD65};

Rgb xyz_of(const glm::dvec2& xy) { return {xy.x / xy.y, 1, (1 - xy.x - xy.y) / xy.y}; }

glm::dmat3 xyz_from(const Primaries& p) {
  const auto column = [](const glm::dvec2& xy) { return Rgb(xy.x, xy.y, 1 - xy.x - xy.y); };
  const glm::dmat3 m(column(p.red), column(p.green), column(p.blue));
  const Rgb scale = glm::inverse(m) * xyz_of(p.white);
  return {m[0] * scale.r, m[1] * scale.g, m[2] * scale.b};
}

/// White to white by Bradford's cones.
glm::dmat3 adapted(const glm::dvec2& from, const glm::dvec2& to) {
  const glm::dmat3 cones = glm::transpose(
      glm::dmat3(0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296));  // written by rows
  const Rgb gain = (cones * xyz_of(to)) / (cones * xyz_of(from));
  return glm::inverse(cones) * glm::dmat3(gain.r, 0, 0, 0, gain.g, 0, 0, 0, gain.b) * cones;
}

Primaries primaries_of(const std::string& name) {
  if (name == "aces2065_1") return {{0.7347, 0.2653}, {0, 1}, {0.0001, -0.0770}, {0.32168, 0.33767}};
  if (name == "adobe_rgb") return {{0.64, 0.33}, {0.21, 0.71}, {0.15, 0.06}, kD65};
  if (name == "lin_p3d65" || name == "display_p3") return {{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, kD65};
  if (name == "acescct" || name == "acescg")
    return {{0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}, {0.32168, 0.33767}};
  if (name == "logc3") return {{0.6840, 0.3130}, {0.2210, 0.8480}, {0.0861, -0.1020}, kD65};
  if (name == "logc4") return {{0.7347, 0.2653}, {0.1424, 0.8576}, {0.0991, -0.0308}, kD65};
  if (name == "slog3") return {{0.766, 0.275}, {0.225, 0.800}, {0.089, -0.087}, kD65};
  if (name == "pq" || name == "hlg" || name == "lin_rec2020")
    return {{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, kD65};
  return kOwn;
}

glm::dmat3 to_own(const std::string& name) {
  const Primaries p = primaries_of(name);
  return glm::inverse(xyz_from(kOwn)) * adapted(p.white, kD65) * xyz_from(p);
}

double powered(double x, double e) { return std::copysign(std::pow(std::abs(x), e), x); }

// AMPAS S-2016-001, 4.3: cut 2^-7 on the side of light.
double acescct_light(double v) {
  return v > 0.155251141552511 ? std::exp2(v * 17.52 - 9.72) : (v - 0.0729055341958355) / 10.5402377416545;
}
double acescct(double x) {
  return x > 0.0078125 ? (std::log2(x) + 9.72) / 17.52 : 10.5402377416545 * x + 0.0729055341958355;
}

// ARRI, Log C Curve, exposure index 800, for linear scene exposure factor.
struct LogC3 {
  static constexpr double cut = 0.010591, a = 5.555556, b = 0.052272, c = 0.247190, d = 0.385537, e = 5.367655,
                          f = 0.092809;
};
double logc3(double x) {
  using K = LogC3;
  return x > K::cut ? K::c * std::log10(K::a * x + K::b) + K::d : K::e * x + K::f;
}
double logc3_light(double v) {
  using K = LogC3;
  return v > K::e * K::cut + K::f ? (std::pow(10, (v - K::d) / K::c) - K::b) / K::a : (v - K::f) / K::e;
}

// ARRI LogC4 Logarithmic Color Space Specification (2022), 3.
struct LogC4 {
  double a = (std::exp2(18) - 16) / 117.45, b = (1023.0 - 95) / 1023, c = 95.0 / 1023;
  double s = 7 * std::log(2.0) * std::exp2(7 - 14 * c / b) / (a * b), t = (std::exp2(14 * (-c / b) + 6) - 64) / a;
};
double logc4(double x) {
  const LogC4 k;
  return x >= k.t ? (std::log2(k.a * x + 64) - 6) / 14 * k.b + k.c : (x - k.t) / k.s;
}
double logc4_light(double v) {
  const LogC4 k;
  return v >= 0 ? (std::exp2(14 * ((v - k.c) / k.b) + 6) - 64) / k.a : v * k.s + k.t;
}

// Sony, Technical Summary for S-Gamut3.Cine/S-Log3.
double slog3(double x) {
  return x >= 0.01125 ? (420 + std::log10((x + 0.01) / (0.18 + 0.01)) * 261.5) / 1023
                      : (x * (171.2102946929 - 95) / 0.01125 + 95) / 1023;
}
double slog3_light(double v) {
  return v >= 171.2102946929 / 1023 ? std::pow(10, (v * 1023 - 420) / 261.5) * (0.18 + 0.01) - 0.01
                                    : (v * 1023 - 95) * 0.01125 / (171.2102946929 - 95);
}

// SMPTE ST 2084, with 203 cd/m² as 1.
struct Pq {
  static constexpr double m1 = 2610.0 / 4096 / 4, m2 = 2523.0 / 4096 * 128, c1 = 3424.0 / 4096, c2 = 2413.0 / 4096 * 32,
                          c3 = 2392.0 / 4096 * 32, white = 203.0 / 10000;
};
double pq(double x) {
  using K = Pq;
  const double y = std::pow(std::max(x, 0.0) * K::white, K::m1);
  return std::pow((K::c1 + K::c2 * y) / (1 + K::c3 * y), K::m2);
}
double pq_light(double v) {
  using K = Pq;
  const double n = std::pow(saturate(v), 1 / K::m2);
  return std::pow(std::max(n - K::c1, 0.0) / (K::c2 - K::c3 * n), 1 / K::m1) / K::white;
}

// ITU-R BT.2100, OETF of HLG, with the signal 0.75 as 1.
struct Hlg {
  static constexpr double a = 0.17883277, b = 1 - 4 * a;
  double c = 0.5 - a * std::log(4 * a);
  double oetf(double e) const { return e <= 1.0 / 12 ? std::sqrt(3 * e) : a * std::log(12 * e - b) + c; }
  double inverse(double v) const { return v <= 0.5 ? v * v / 3 : (std::exp((v - c) / a) + b) / 12; }
};
double hlg(double x) {
  const Hlg k;
  return k.oetf(std::max(x, 0.0) * k.inverse(0.75));
}
double hlg_light(double v) {
  const Hlg k;
  return k.inverse(std::max(v, 0.0)) / k.inverse(0.75);
}

double as_is(double x) { return x; }
constexpr double kAdobe = 2 + 51.0 / 256;
double adobe(double x) { return powered(x, 1 / kAdobe); }
double adobe_light(double v) { return powered(v, kAdobe); }
double gamma22(double x) { return powered(x, 1 / 2.2); }
double gamma22_light(double v) { return powered(v, 2.2); }
double gamma24(double x) { return powered(x, 1 / 2.4); }
double gamma24_light(double v) { return powered(v, 2.4); }

// Codes of 1023 count 0.002 of printing density; 95 is black, 685 white, and film's gamma is 0.6.
double cineon_light(double v) {
  const double exposure = std::pow(10.0, 0.002 * (1023 * v - 685) / 0.6),
               base = std::pow(10.0, 0.002 * (95 - 685) / 0.6);
  return (exposure - base) / (1 - base);
}
double cineon(double x) {
  const double base = std::pow(10.0, 0.002 * (95 - 685) / 0.6);
  return (685 + 0.6 / 0.002 * std::log10(std::max(x * (1 - base) + base, 1e-12))) / 1023;
}

// BT.709's camera curve with the digits of BT.2020, odd around 0.
constexpr double kCameraAlpha = 1.09929682680944, kCameraBeta = 0.018053968510807;
double rec709(double x) {
  const double a = std::abs(x);
  return std::copysign(a < kCameraBeta ? 4.5 * a : kCameraAlpha * std::pow(a, 0.45) - (kCameraAlpha - 1), x);
}
double rec709_light(double v) {
  const double a = std::abs(v);
  const double x = a < 4.5 * kCameraBeta ? a / 4.5 : std::pow((a + (kCameraAlpha - 1)) / kCameraAlpha, 1 / 0.45);
  return std::copysign(x, v);
}

struct Transfer {
  const char* name;
  double (*to_light)(double);
  double (*from_light)(double);
};
constexpr Transfer kTransfers[] = {{"aces2065_1", as_is, as_is},
                                   {"acescg", as_is, as_is},
                                   {"lin_p3d65", as_is, as_is},
                                   {"lin_rec2020", as_is, as_is},
                                   {"acescct", acescct_light, acescct},
                                   {"cineon", cineon_light, cineon},
                                   {"adobe_rgb", adobe_light, adobe},
                                   {"display_p3", srgb_to_linear, linear_to_srgb},
                                   {"gamma22", gamma22_light, gamma22},
                                   {"gamma24", gamma24_light, gamma24},
                                   {"hlg", hlg_light, hlg},
                                   {"linear", as_is, as_is},
                                   {"logc3", logc3_light, logc3},
                                   {"logc4", logc4_light, logc4},
                                   {"pq", pq_light, pq},
                                   {"rec709", rec709_light, rec709},
                                   {"slog3", slog3_light, slog3},
                                   {"srgb", srgb_to_linear, linear_to_srgb}};

const Transfer& transfer(const std::string& name) {
  for (const auto& one : kTransfers)
    if (name == one.name) return one;
  throw std::invalid_argument("no transfer '" + name + "'");
}

}  // namespace

const std::vector<std::string>& transfer_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const auto& one : kTransfers) all.emplace_back(one.name);
    return all;
  }();
  return names;
}

const std::vector<std::string>& table_spaces() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = transfer_names();
    std::erase_if(all, [](const std::string& name) {
      const bool linear = transfer(name).to_light == as_is && name != "linear";
      return linear || name == "adobe_rgb" || name == "display_p3";  // of pictures alone
    });
    return all;
  }();
  return names;
}

double transfer_to_light(const std::string& name, double stored) { return transfer(name).to_light(stored); }
double light_to_transfer(const std::string& name, double light) { return transfer(name).from_light(light); }

Rgb transfer_to_rec709(const std::string& name, const Rgb& stored) {
  const auto to_light = transfer(name).to_light;
  return to_own(name) * Rgb(to_light(stored.r), to_light(stored.g), to_light(stored.b));
}

Rgb rec709_to_transfer(const std::string& name, const Rgb& light) {
  const Rgb c = glm::inverse(to_own(name)) * light;
  const auto from_light = transfer(name).from_light;
  return {from_light(c.r), from_light(c.g), from_light(c.b)};
}

}  // namespace afterglow::reference
