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
  if (name == "slog3_sgamut3") return {{0.730, 0.280}, {0.140, 0.855}, {0.100, -0.050}, kD65};
  if (name == "vlog") return {{0.730, 0.280}, {0.165, 0.840}, {0.100, -0.030}, kD65};
  if (name == "clog2" || name == "clog3") return {{0.740, 0.270}, {0.170, 1.140}, {0.080, -0.100}, kD65};
  if (name == "log3g10") return {{0.780308, 0.304253}, {0.121595, 1.493994}, {0.095612, -0.084589}, kD65};
  if (name == "davinci_intermediate") return {{0.8000, 0.3130}, {0.1682, 0.9877}, {0.0790, -0.1155}, kD65};
  if (name == "bmd_film5")
    return {{0.7177215, 0.3171181}, {0.2280410, 0.8615690}, {0.1005841, -0.0820452}, {0.3127170, 0.3290312}};
  if (name == "pq" || name == "hlg" || name == "hlg_1000" || name == "lin_rec2020" || name == "apple_log")
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

// Panasonic, V-Log/V-Gamut Reference Manual: both pieces as the manual writes them.
double vlog(double x) { return x < 0.01 ? 5.6 * x + 0.125 : 0.241514 * std::log10(x + 0.00873) + 0.598206; }
double vlog_light(double v) {
  return v < 0.181 ? (v - 0.125) / 5.6 : std::pow(10, (v - 0.598206) / 0.241514) - 0.00873;
}

// Canon Log 2 and 3 of 2016, whose x is light over 0.9.
double clog2(double light) {
  const double x = light / 0.9;
  return x < 0 ? -(0.24136077 * std::log10(1 - 87.099375 * x) - 0.092864125)
               : 0.24136077 * std::log10(87.099375 * x + 1) + 0.092864125;
}
double clog2_light(double v) {
  return 0.9 * (v < 0.092864125 ? -(std::pow(10, (0.092864125 - v) / 0.24136077) - 1) / 87.099375
                                : (std::pow(10, (v - 0.092864125) / 0.24136077) - 1) / 87.099375);
}
double clog3(double light) {
  const double x = light / 0.9;
  if (x < -0.014) return -(0.36726845 * std::log10(1 - 14.98325 * x) - 0.12783901);
  if (x <= 0.014) return 1.9754798 * x + 0.12512219;
  return 0.36726845 * std::log10(14.98325 * x + 1) + 0.12240537;
}
double clog3_light(double v) {
  if (v < 0.097465473) return 0.9 * -(std::pow(10, (0.12783901 - v) / 0.36726845) - 1) / 14.98325;
  if (v <= 0.15277891) return 0.9 * (v - 0.12512219) / 1.9754798;
  return 0.9 * (std::pow(10, (v - 0.12240537) / 0.36726845) - 1) / 14.98325;
}

// RED's white paper of 2017: log3G10 of x + 0.01.
double log3g10(double x) {
  const double y = x + 0.01;
  return y < 0 ? y * 15.1927 : 0.224282 * std::log10(y * 155.975327 + 1);
}
double log3g10_light(double v) { return (v < 0 ? v / 15.1927 : (std::pow(10, v / 0.224282) - 1) / 155.975327) - 0.01; }

// DaVinci Intermediate: A, B, C, M and the two cuts of its paper.
double davinci(double x) { return x <= 0.00262409 ? x * 10.44426855 : (std::log2(x + 0.0075) + 7) * 0.07329248; }
double davinci_light(double v) { return v <= 0.02740668 ? v / 10.44426855 : std::exp2(v / 0.07329248 - 7) - 0.0075; }

// Blackmagic Film, generation 5.
struct Film5 {
  static constexpr double a = 0.08692876065491224, b = 0.005494072432257808, c = 0.5300133392291939,
                          d = 8.283605932402494, e = 0.09246575342465753, cut = 0.005;
};
double film5(double x) {
  using K = Film5;
  return x < K::cut ? K::d * x + K::e : K::a * std::log(x + K::b) + K::c;
}
double film5_light(double v) {
  using K = Film5;
  return v < K::d * K::cut + K::e ? (v - K::e) / K::d : std::exp((v - K::c) / K::a) - K::b;
}

// Apple Log: R0, Rt, c, beta, gamma and delta of its paper.
struct AppleLog {
  static constexpr double r0 = -0.05641088, rt = 0.01, c = 47.28711236, beta = 0.00964052, gamma = 0.08550479,
                          delta = 0.69336945, pt = c * (rt - r0) * (rt - r0);
};
double apple_log(double x) {
  using K = AppleLog;
  if (x < K::r0) return 0;
  return x < K::rt ? K::c * (x - K::r0) * (x - K::r0) : K::gamma * std::log2(x + K::beta) + K::delta;
}
double apple_log_light(double v) {
  using K = AppleLog;
  if (v < 0) return K::r0;
  return v < K::pt ? std::sqrt(v / K::c) + K::r0 : std::exp2((v - K::delta) / K::gamma) - K::beta;
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

// BT.2100, table 5: a display of 1000 cd/m² shows alpha·Ys^(gamma − 1)·Es, with gamma 1.2; 203 cd/m² is 1. What is
// "light" of one channel here is Es·(1000/203)^(1/gamma), so that greys are its power gamma.
constexpr double kHlgGamma = 1.2;
const double kHlgPeak = std::pow(1000.0 / 203, 1 / kHlgGamma);
double hlg_1000(double x) { return Hlg{}.oetf(std::max(x, 0.0) / kHlgPeak); }
double hlg_1000_light(double v) { return Hlg{}.inverse(std::max(v, 0.0)) * kHlgPeak; }
Rgb hlg_display(const Rgb& scene) {
  const double luminance = glm::dot(Rgb(0.2627, 0.6780, 0.0593), scene);
  return luminance > 0 ? scene * std::pow(luminance, kHlgGamma - 1) : Rgb(0);
}
Rgb hlg_scene(const Rgb& light) {
  const Rgb display = glm::max(light, Rgb(0));
  const double luminance = glm::dot(Rgb(0.2627, 0.6780, 0.0593), display);
  return luminance > 0 ? display * std::pow(luminance, (1 - kHlgGamma) / kHlgGamma) : Rgb(0);
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
                                   {"hlg_1000", hlg_1000_light, hlg_1000},
                                   {"linear", as_is, as_is},
                                   {"logc3", logc3_light, logc3},
                                   {"logc4", logc4_light, logc4},
                                   {"pq", pq_light, pq},
                                   {"rec709", rec709_light, rec709},
                                   {"slog3", slog3_light, slog3},
                                   {"slog3_sgamut3", slog3_light, slog3},
                                   {"vlog", vlog_light, vlog},
                                   {"clog2", clog2_light, clog2},
                                   {"clog3", clog3_light, clog3},
                                   {"log3g10", log3g10_light, log3g10},
                                   {"davinci_intermediate", davinci_light, davinci},
                                   {"bmd_film5", film5_light, film5},
                                   {"apple_log", apple_log_light, apple_log},
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
      return linear || name == "adobe_rgb" || name == "display_p3" || name == "hlg_1000";  // of pictures alone
    });
    return all;
  }();
  return names;
}

double transfer_to_light(const std::string& name, double stored) { return transfer(name).to_light(stored); }
double light_to_transfer(const std::string& name, double light) { return transfer(name).from_light(light); }

Rgb transfer_to_rec709(const std::string& name, const Rgb& stored) {
  const auto to_light = transfer(name).to_light;
  const Rgb light(to_light(stored.r), to_light(stored.g), to_light(stored.b));
  return to_own(name) * (name == "hlg_1000" ? hlg_display(light) : light);
}

Rgb rec709_to_transfer(const std::string& name, const Rgb& light) {
  const Rgb own = glm::inverse(to_own(name)) * light, c = name == "hlg_1000" ? hlg_scene(own) : own;
  const auto from_light = transfer(name).from_light;
  return {from_light(c.r), from_light(c.g), from_light(c.b)};
}

}  // namespace afterglow::reference
