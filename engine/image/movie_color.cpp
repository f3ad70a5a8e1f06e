// SPDX-License-Identifier: MIT
#include "image/movie_color.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "core/text.h"
#include "image/input_space.h"

namespace afterglow {
namespace {

constexpr std::array<double, 2> kWhiteC{0.310, 0.316}, kWhiteD65{0.3127, 0.3290}, kWhiteDci{0.314, 0.351};

/// H.273, table 2.
std::optional<Chromaticities> primaries_of(int code) {
  switch (code) {
    case 4:
      return Chromaticities{{0.67, 0.33}, {0.21, 0.71}, {0.14, 0.08}, kWhiteC};
    case 5:
      return Chromaticities{{0.64, 0.33}, {0.29, 0.60}, {0.15, 0.06}, kWhiteD65};
    case 6:
    case 7:
      return Chromaticities{{0.630, 0.340}, {0.310, 0.595}, {0.155, 0.070}, kWhiteD65};
    case 8:
      return Chromaticities{{0.681, 0.319}, {0.243, 0.692}, {0.145, 0.049}, kWhiteC};
    case 9:
      return Chromaticities{{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, kWhiteD65};
    case 10:
      return Chromaticities{{1, 0}, {0, 1}, {0, 0}, {1.0 / 3, 1.0 / 3}};
    case 11:
      return Chromaticities{{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, kWhiteDci};
    case 12:
      return Chromaticities{{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, kWhiteD65};
    case 22:
      return Chromaticities{{0.630, 0.340}, {0.295, 0.605}, {0.155, 0.077}, kWhiteD65};
    default:
      return std::nullopt;
  }
}

// H.273, table 3.
double from_240m(double v) { return v < 4 * 0.0228 ? v / 4 : std::pow((v + 0.1115) / 1.1115, 1 / 0.45); }
double from_log100(double v) { return v <= 0 ? 0 : std::pow(10.0, 2 * (v - 1)); }
double from_log316(double v) { return v <= 0 ? 0 : std::pow(10.0, 2.5 * (v - 1)); }
double from_428(double v) { return 52.37 / 48 * std::pow(std::max(v, 0.0), 2.6); }

void use_formula(ColorEncoding& encoding, double (*formula)(double)) {
  encoding.curve = TransferCurve::formula;
  encoding.formula = formula;
}
void use_power(ColorEncoding& encoding, double exponent) {
  encoding.curve = TransferCurve::power;
  encoding.exponent = exponent;
}

void use_transfer(ColorEncoding& encoding, int code) {
  switch (code) {
    case 4:
      return use_power(encoding, 2.2);
    case 5:
      return use_power(encoding, 2.8);
    case 7:
      return use_formula(encoding, from_240m);
    case 8:
      encoding.curve = TransferCurve::linear;
      return;
    case 9:
      return use_formula(encoding, from_log100);
    case 10:
      return use_formula(encoding, from_log316);
    case 13:
      encoding.curve = TransferCurve::srgb;
      return;
    case 16:
      return use_formula(encoding, find_input_space("pq").value()->to_linear);
    case 17:
      return use_formula(encoding, from_428);
    case 18:
      return use_formula(encoding, find_input_space("hlg").value()->to_linear);
    default:  // 1, 6, 14, 15: one curve; 11 and 12 mirror it
      return use_formula(encoding, find_input_space("rec709").value()->to_linear);
  }
}

bool is_known_transfer(int code) { return (code >= 4 && code <= 18) || code == 1; }
bool is_known_matrix(int code) { return code == 1 || (code >= 4 && code <= 9) || code == 12 || code == 14; }

/// What no RGB is made of; null: it is made.
const char* unreadable_matrix(int code) {
  if (code == 10 || code == 13) return "constant luminance";
  return code == 11 ? "SMPTE ST 2085" : nullptr;
}

/// The primaries that go with a matrix alone; BT.601's goes with several. None: it tells nothing.
std::optional<int> primaries_with(int matrix) {
  if (matrix == 1) return 1;
  if (matrix == 9) return 9;
  return std::nullopt;
}

bool is_small(const Size& size) {
  constexpr int kSdWidth = 1024, kSdHeight = 576;
  return size.width <= kSdWidth && size.height <= kSdHeight;
}

}  // namespace

Result<void> fill_in(MovieFacts& facts) {
  MovieColor& color = facts.color;
  if (const char* kind = color.rgb ? nullptr : unreadable_matrix(color.matrix))
    return Error{ErrorKind::io,
                 fmt::format("is stored by a matrix that is not read ({}, number {} of H.273)", kind, color.matrix)};
  const bool small = is_small(facts.stored), sixty = facts.stored.height == 480 || facts.stored.height == 486;
  std::vector<std::string> taken;
  const bool srgb = color.rgb || color.picture;
  if (facts.floating && color.transfer == kUnsaid) color.transfer = 8;  // as in pictures: floats are light
  const auto take = [&](int& code, bool known, int value, const char* what) {
    if (known) return;
    if (code != kUnsaid && code != 0 && code != 3)
      facts.warnings.push_back(
          fmt::format("its {} {} (of H.273) is not known here; its colours may be others", what, code));
    code = value;
    taken.emplace_back(what);
  };
  if (!color.rgb && !facts.grey) {
    if (color.matrix == 0) color.matrix = kUnsaid;  // RGB's: not of what is stored
    const int by_size = small || color.picture ? (sixty ? 6 : 5) : 1;
    take(color.matrix, is_known_matrix(color.matrix), color.primaries == 9 ? 9 : by_size, "matrix");
  }
  const bool matrix_said = !facts.grey && taken.empty();
  const auto with_matrix = matrix_said ? primaries_with(color.matrix) : std::nullopt;
  const bool primaries_said = color.primaries == 1 || primaries_of(color.primaries).has_value();
  take(color.primaries, primaries_said, srgb ? 1 : with_matrix.value_or(!small ? 1 : sixty ? 6 : 5), "primaries");
  take(color.transfer, is_known_transfer(color.transfer), srgb ? 13 : 1, "transfer");
  constexpr int kIctcp = 14, kHlg = 18;
  if (!color.rgb && color.matrix == kIctcp && color.transfer == kHlg)
    facts.warnings.emplace_back("is stored as ICtCp of HLG: saturated colours are read up to 3 % off");
  const bool wide = color.primaries == 9;
  const bool usual = color.rgb && color.picture;  // sRGB, as that of any picture; its own chunks say more
  if (!taken.empty() && !usual)
    facts.notes.push_back(fmt::format("does not say its {}; {} is taken", join(taken, ", "),
                                      srgb                            ? "sRGB"
                                      : wide                          ? "BT.2020, as the rest,"
                                      : small && color.primaries != 1 ? "BT.601, as of standard definition,"
                                                                      : "BT.709"));
  return {};
}

bool use_codes(int primaries, int transfer, ColorEncoding& encoding) {
  const auto known = primaries_of(primaries);
  const bool said = known || primaries == 1 || primaries == kUnsaid;
  if (!said || (transfer != kUnsaid && !is_known_transfer(transfer))) return false;
  if (transfer != kUnsaid) use_transfer(encoding, transfer);
  if (primaries != kUnsaid) encoding.matrix.reset();
  if (!known || encoding.grey) return true;
  const Matrix3 matrix = to_rec709(*known);
  if (!nearly_equal(matrix, kIdentity, 1e-6)) encoding.matrix = matrix;
  return true;
}

ColorEncoding movie_encoding(const MovieFacts& facts) {
  ColorEncoding encoding;
  encoding.dense = true;
  encoding.alpha = facts.has_alpha ? AlphaKind::straight : AlphaKind::none;
  use_codes(facts.color.primaries, facts.color.transfer, encoding);
  return encoding;
}

}  // namespace afterglow
