// SPDX-License-Identifier: MIT
#include "image/container_color.h"

#include <fmt/format.h>

#include <cmath>

#include "image/icc_profile.h"
#include "image/input_space.h"
#include "image/movie_color.h"

namespace afterglow {
namespace {

bool use_profile(std::span<const std::uint8_t> profile, const std::string& name, ColorEncoding& encoding,
                 Diagnostics& diagnostics) {
  if (profile.empty()) return false;
  const auto used = use_icc_profile(profile, encoding.grey ? 1 : 3, encoding);
  if (!used) diagnostics.warn(fmt::format("{}: {}; the profile is ignored", name, used.error().message));
  return used.ok();
}

/// Numbers of H.273. False: they have no meaning here.
bool use_numbers(const ContainerFacts::Codes& codes, const std::string& name, ColorEncoding& encoding,
                 Diagnostics& diagnostics) {
  const bool used = use_codes(codes.primaries, codes.transfer, encoding);
  if (!used)
    diagnostics.warn(fmt::format("{}: its colours (primaries {}, transfer {} of H.273) are not known; they are ignored",
                                 name, codes.primaries, codes.transfer));
  if (codes.limited)
    diagnostics.warn(
        fmt::format("{}: says that its samples have the range of video; they are read as of full range", name));
  return used;
}

/// PNG's own rules: iCCP before sRGB before gAMA and cHRM.
void use_png_chunks(const ContainerFacts& container, const std::string& name, ColorEncoding& encoding,
                    Diagnostics& diagnostics) {
  if (container.srgb) return;
  const Matrix3 matrix = container.primaries ? to_rec709(*container.primaries) : kIdentity;
  const bool own = nearly_equal(matrix, kIdentity, 3e-3);
  if (container.gamma) {
    // What programs write that mean sRGB but do not know the sRGB chunk (PNG, 11.3.2.5), with its primaries where they
    // say any; other numbers, and other primaries, mean what they say.
    constexpr double kSrgb = 0.45455;
    const double exponent = 1 / *container.gamma;
    if (std::abs(exponent - 1) < 0.01) {
      encoding.curve = TransferCurve::linear;
    } else if ((!own || std::abs(*container.gamma - kSrgb) > 1e-5) && exponent > 0.1 && exponent < 10) {
      encoding.curve = TransferCurve::power;
      encoding.exponent = exponent;
    }
  }
  if (!container.primaries || encoding.grey) return;
  if (matrix == Matrix3{}) {
    diagnostics.warn(fmt::format("{}: its chromaticities make no sense; Rec.709 is assumed", name));
  } else if (!own) {
    encoding.matrix = matrix;
  }
}

}  // namespace

bool use_container_color(const ContainerFacts& container, std::span<const std::uint8_t> profile,
                         const std::string& name, ColorEncoding& encoding, Diagnostics& diagnostics) {
  const bool png = container.kind == ContainerFacts::Kind::png;
  const auto& codes = container.codes;
  const bool whole = png && codes && codes->primaries != kUnsaid && codes->transfer != kUnsaid;
  if (whole && use_numbers(*codes, name, encoding, diagnostics)) return true;  // before iCCP, as PNG has it
  if (use_profile(profile, name, encoding, diagnostics)) return true;
  if (container.adobe_rgb) {
    use_input_space(**find_input_space("adobe_rgb"), encoding);
    return true;
  }
  if (png) use_png_chunks(container, name, encoding, diagnostics);
  if (codes && !whole) use_numbers(*codes, name, encoding, diagnostics);  // what they say
  return png || codes.has_value();
}

}  // namespace afterglow
