// SPDX-License-Identifier: MIT
#include "image/input_space.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/text.h"
#include "image/hlg_rendering.h"
#include "image/srgb.h"

namespace afterglow {
namespace {

constexpr std::array<double, 2> kD65{0.3127, 0.3290};
constexpr Chromaticities kAp0{{0.7347, 0.2653}, {0.0, 1.0}, {0.0001, -0.0770}, {0.32168, 0.33767}};
constexpr Chromaticities kP3{{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, kD65};
constexpr Chromaticities kAdobeRgb{{0.64, 0.33}, {0.21, 0.71}, {0.15, 0.06}, kD65};
constexpr Chromaticities kAp1{{0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}, {0.32168, 0.33767}};
constexpr Chromaticities kWideGamut3{{0.6840, 0.3130}, {0.2210, 0.8480}, {0.0861, -0.1020}, kD65};
constexpr Chromaticities kWideGamut4{{0.7347, 0.2653}, {0.1424, 0.8576}, {0.0991, -0.0308}, kD65};
constexpr Chromaticities kSGamut3Cine{{0.766, 0.275}, {0.225, 0.800}, {0.089, -0.087}, kD65};
constexpr Chromaticities kSGamut3{{0.730, 0.280}, {0.140, 0.855}, {0.100, -0.050}, kD65};
constexpr Chromaticities kVGamut{{0.730, 0.280}, {0.165, 0.840}, {0.100, -0.030}, kD65};
constexpr Chromaticities kCinemaGamut{{0.740, 0.270}, {0.170, 1.140}, {0.080, -0.100}, kD65};
constexpr Chromaticities kRedWideGamut{{0.780308, 0.304253}, {0.121595, 1.493994}, {0.095612, -0.084589}, kD65};
constexpr Chromaticities kDavinciWideGamut{{0.8000, 0.3130}, {0.1682, 0.9877}, {0.0790, -0.1155}, kD65};
constexpr Chromaticities kFilmWideGamut5{
    {0.7177215, 0.3171181}, {0.2280410, 0.8615690}, {0.1005841, -0.0820452}, {0.3127170, 0.3290312}};
constexpr Chromaticities kRec2020{{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, kD65};

// AMPAS S-2016-001.
double from_acescct(double v) {
  constexpr double kBreak = 0.155251141552511;
  return v <= kBreak ? (v - 0.0729055341958355) / 10.5402377416545 : std::exp2(17.52 * std::min(v, 3.0) - 9.72);
}

// ARRI, "ALEXA Log C Curve, Usage in VFX" (2017), exposure index 800.
double from_logc3(double v) {
  constexpr double cut = 0.010591, a = 5.555556, b = 0.052272, c = 0.247190, d = 0.385537, e = 5.367655, f = 0.092809;
  return v > e * cut + f ? (std::pow(10.0, (std::min(v, 8.0) - d) / c) - b) / a : (v - f) / e;
}

// ARRI, "LogC4 Logarithmic Color Space Specification" (2022).
double from_logc4(double v) {
  const double a = (262144.0 - 16) / 117.45, b = 928.0 / 1023, c = 95.0 / 1023;
  if (v >= 0) return (std::exp2(14 * (std::min(v, 8.0) - c) / b + 6) - 64) / a;
  const double s = 7 * std::log(2.0) * std::exp2(7 - 14 * c / b) / (a * b), t = (std::exp2(6 - 14 * c / b) - 64) / a;
  return v * s + t;
}

// Sony, "Technical Summary for S-Gamut3.Cine/S-Log3" (2014).
double from_slog3(double v) {
  return v >= 171.2102946929 / 1023 ? std::pow(10.0, (std::min(v, 8.0) * 1023 - 420) / 261.5) * (0.18 + 0.01) - 0.01
                                    : (v * 1023 - 95) * 0.01125 / (171.2102946929 - 95);
}

// Panasonic, "V-Log/V-Gamut Reference Manual" (2014).
double from_vlog(double v) {
  constexpr double b = 0.00873, c = 0.241514, d = 0.598206;
  return v < 0.181 ? (v - 0.125) / 5.6 : std::pow(10.0, (std::min(v, 8.0) - d) / c) - b;
}

// Canon, "EOS C300 Mark II: Canon Log 2/3 Transfer Characteristics" (2016); its 1 is a reflectance of 0.9.
double from_clog2(double v) {
  constexpr double a = 0.24136077, b = 0.092864125, c = 87.099375;
  return 0.9 * std::copysign(std::pow(10.0, std::abs(std::clamp(v, -8.0, 8.0) - b) / a) - 1, v - b) / c;
}
double from_clog3(double v) {
  constexpr double a = 0.36726845, c = 14.98325;
  if (v < 0.097465473) return -0.9 * (std::pow(10.0, (0.12783901 - std::max(v, -8.0)) / a) - 1) / c;
  if (v <= 0.15277891) return 0.9 * (v - 0.12512219) / 1.9754798;
  return 0.9 * (std::pow(10.0, (std::min(v, 8.0) - 0.12240537) / a) - 1) / c;
}

// RED, "White Paper on REDWideGamutRGB and Log3G10" (2017).
double from_log3g10(double v) {
  constexpr double a = 0.224282, b = 155.975327, c = 0.01, g = 15.1927;
  return v < 0 ? v / g - c : (std::pow(10.0, std::min(v, 8.0) / a) - 1) / b - c;
}

// Blackmagic Design, "DaVinci Resolve 17 Wide Gamut Intermediate" (2021).
double from_davinci(double v) {
  return v <= 0.02740668 ? v / 10.44426855 : std::exp2(std::min(v, 4.0) / 0.07329248 - 7) - 0.0075;
}

// Blackmagic Design, "Generation 5 Color Science" (2021).
double from_film5(double v) {
  constexpr double a = 0.08692876065491224, b = 0.005494072432257808, c = 0.5300133392291939, d = 8.283605932402494,
                   e = 0.09246575342465753;
  return v < d * 0.005 + e ? (v - e) / d : std::exp((std::min(v, 4.0) - c) / a) - b;
}

// Apple, "Apple Log Profile White Paper" (2023). It ends at −0.056.
double from_apple_log(double v) {
  constexpr double first = -0.05641088, cut = 0.01, c = 47.28711236, b = 0.00964052, g = 0.08550479, d = 0.69336945;
  return v >= c * (cut - first) * (cut - first) ? std::exp2((std::min(v, 4.0) - d) / g) - b
                                                : std::sqrt(std::max(v, 0.0) / c) + first;
}

// SMPTE ST 2084; 203 cd/m², the white of ITU-R BT.2408, is 1.
double from_pq(double v) {
  constexpr double m1 = 2610.0 / 16384, m2 = 2523.0 / 4096 * 128, c1 = 3424.0 / 4096, c2 = 2413.0 / 4096 * 32,
                   c3 = 2392.0 / 4096 * 32;
  const double p = std::pow(std::clamp(v, 0.0, 1.0), 1 / m2);
  return 10000.0 / 203 * std::pow(std::max(p - c1, 0.0) / (c2 - c3 * p), 1 / m1);
}

// ITU-R BT.2100 HLG, light of the scene; the signal 0.75, the white of BT.2408, is 1.
double hlg_scene(double v) {
  constexpr double a = 0.17883277, b = 0.28466892, c = 0.55991073;
  return v <= 0.5 ? v * v / 3 : (std::exp((std::min(v, 4.0) - c) / a) + b) / 12;
}
double from_hlg(double v) { return hlg_scene(std::max(v, 0.0)) / hlg_scene(0.75); }
/// Greys of a display of 1000 cd/m² are the γ-th power of this; 203 cd/m² is 1, as of PQ.
double from_hlg_1000(double v) {
  static const double peak = std::pow(1000.0 / 203, 1 / kHlgGamma);
  return peak * hlg_scene(std::max(v, 0.0));
}

// Kodak, "Conversion of 10-bit Log Film Data to 8-bit Linear or Video Data" (1995), as the field reads it: printing
// density, 0.002 a code, gamma 0.6; code 95 is black, 685 is a white that diffuses.
double from_cineon(double v) {
  const double black = std::pow(10.0, (95.0 - 685.0) / 300);
  return (std::pow(10.0, (std::min(v, 8.0) * 1023 - 685) / 300) - black) / (1 - black);
}

// ITU-R BT.709-6: the curve of cameras, undone; with the digits of BT.2020, so that its two pieces meet.
double from_rec709(double v) {
  constexpr double kAlpha = 1.09929682680944, kBeta = 0.018053968510807;
  const double a = std::abs(v);
  return std::copysign(a < 4.5 * kBeta ? a / 4.5 : std::pow((a + kAlpha - 1) / kAlpha, 1 / 0.45), v);
}

double mirrored_power(double v, double exponent) { return std::copysign(std::pow(std::abs(v), exponent), v); }
double from_gamma22(double v) { return mirrored_power(v, 2.2); }
double from_gamma24(double v) { return mirrored_power(v, 2.4); }
// Adobe RGB (1998) Color Image Encoding, 2005-05: 2 + 51/256.
double from_adobe_rgb(double v) { return mirrored_power(v, 563.0 / 256); }
double as_it_is(double v) { return v; }

constexpr std::array kSpaces{
    InputSpace{"aces2065_1", "linear ACES2065-1 (SMPTE ST 2065-1), primaries AP0", as_it_is, kAp0},
    InputSpace{"acescct", "ACEScct (AMPAS S-2016-001), primaries AP1", from_acescct, kAp1},
    InputSpace{"acescg", "linear ACEScg (AMPAS S-2014-004), primaries AP1", as_it_is, kAp1},
    InputSpace{"adobe_rgb", "Adobe RGB (1998)", from_adobe_rgb, kAdobeRgb, true},
    InputSpace{"apple_log", "Apple Log, Rec.2020", from_apple_log, kRec2020},
    InputSpace{"bmd_film5", "Blackmagic Film and Wide Gamut, generation 5", from_film5, kFilmWideGamut5},
    InputSpace{"cineon", "Cineon printing density (black 95, white 685 of 1023), Rec.709", from_cineon, kRec709},
    InputSpace{"clog2", "Canon Log 2, Cinema Gamut", from_clog2, kCinemaGamut},
    InputSpace{"clog3", "Canon Log 3, Cinema Gamut", from_clog3, kCinemaGamut},
    InputSpace{"davinci_intermediate", "DaVinci Intermediate, DaVinci Wide Gamut", from_davinci, kDavinciWideGamut},
    InputSpace{"display_p3", "Display P3: the curve of sRGB, P3 with the white of D65", srgb_to_linear, kP3, true},
    InputSpace{"gamma22", "power 2.2, Rec.709", from_gamma22, kRec709, true},
    InputSpace{"gamma24", "power 2.4, Rec.709", from_gamma24, kRec709, true},
    InputSpace{"hlg", "HLG (ITU-R BT.2100), Rec.2020; the signal 0.75 is 1", from_hlg, kRec2020},
    InputSpace{"hlg_1000", "HLG as a display of 1000 cd/m² shows it (BT.2100's OOTF), Rec.2020; 203 cd/m² is 1",
               from_hlg_1000, kRec2020, false, true},
    InputSpace{"lin_p3d65", "linear P3 with the white of D65 (SMPTE EG 432-1)", as_it_is, kP3},
    InputSpace{"lin_rec2020", "linear Rec.2020", as_it_is, kRec2020},
    InputSpace{"linear", "linear Rec.709", as_it_is, kRec709},
    InputSpace{"log3g10", "RED Log3G10, REDWideGamutRGB", from_log3g10, kRedWideGamut},
    InputSpace{"logc3", "ARRI LogC3 at EI 800, ALEXA Wide Gamut 3", from_logc3, kWideGamut3},
    InputSpace{"logc4", "ARRI LogC4, ARRI Wide Gamut 4", from_logc4, kWideGamut4},
    InputSpace{"pq", "PQ (SMPTE ST 2084), Rec.2020; 203 cd/m² is 1", from_pq, kRec2020},
    InputSpace{"rec709", "BT.709, the curve of cameras", from_rec709, kRec709, true},
    InputSpace{"slog3", "Sony S-Log3, S-Gamut3.Cine", from_slog3, kSGamut3Cine},
    InputSpace{"slog3_sgamut3", "Sony S-Log3, S-Gamut3", from_slog3, kSGamut3},
    InputSpace{"srgb", "sRGB (IEC 61966-2-1)", srgb_to_linear, kRec709, true},
    InputSpace{"vlog", "Panasonic V-Log, V-Gamut", from_vlog, kVGamut},
};

}  // namespace

bool InputSpace::linear() const { return to_linear == as_it_is; }

std::span<const InputSpace> input_spaces() { return kSpaces; }

std::vector<std::string> input_space_names() {
  std::vector<std::string> names;
  for (const InputSpace& space : kSpaces) names.emplace_back(space.name);
  return names;
}

Result<const InputSpace*> find_input_space(const std::string& name) {
  for (const InputSpace& space : kSpaces)
    if (name == space.name) return &space;
  const std::vector<std::string> names = input_space_names();
  return Error{ErrorKind::usage, "'" + name + "' is no input space", "", 0, join(names), nearest_name(name, names)};
}

void use_input_space(const InputSpace& space, ColorEncoding& encoding) {
  encoding.curve = space.linear() ? TransferCurve::linear : TransferCurve::formula;
  encoding.formula = space.to_linear;
  encoding.transform.reset();
  encoding.matrix.reset();
  encoding.hlg_display = space.hlg_display;
  if (encoding.grey) return;
  const Matrix3 matrix = to_rec709(space.primaries);
  if (!nearly_equal(matrix, kIdentity, 1e-6)) encoding.matrix = matrix;
}

}  // namespace afterglow
