// SPDX-License-Identifier: MIT
// ICC profiles, through Little CMS.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "image/color_encoding.h"
#include "image/ocio.h"

namespace afterglow {

/// Sets curve and matrix (or transform) of `encoding` from a profile. `channels` 1 or 3: what the file stores. A
/// profile that is sRGB in all but name gives the sRGB curve itself. Errors: io (damaged, or for another number of
/// channels); `encoding` is then unchanged.
Result<void> use_icc_profile(std::span<const std::uint8_t> profile, int channels, ColorEncoding& encoding);

/// Linear Rec.709 of a display to the codes of another, which the profile is of: relative colorimetric, black point
/// compensated, in floats.
struct DisplayProfile {
  std::string name;  ///< as the profile describes itself, in ASCII; may be empty
  ColorFunction apply;
};
/// Errors: io (damaged; not of RGB; for reading alone, as those of cameras).
Result<DisplayProfile> display_profile(std::span<const std::uint8_t> profile);

/// An sRGB profile; the same bytes every time.
std::vector<std::uint8_t> srgb_icc_profile();

}  // namespace afterglow
