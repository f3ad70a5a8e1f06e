// SPDX-License-Identifier: MIT
// The lossy part of OpenEXR's DWA: blocks of 8×8 pixels become cosines, each the half float with the fewest bits set
// within its tolerance.
#pragma once

#include <array>
#include <cstdint>

namespace afterglow {

inline constexpr int kDctSide = 8, kDctSize = 64;

/// What DWA keeps instead of a half float: the power 1/2.2 up to 1, a logarithm above; 0 for what is not finite.
/// 65536 values.
const float* dwa_curve();

/// The half float with the fewest bits set among those that differ from `value` by at most `tolerance`, the nearest of
/// several; where there is none, the nearest half float. `value` is finite and within their range.
std::uint16_t with_few_bits(float value, float tolerance);

/// A block's channels R, G, B: as dwa_curve() has them, row by row.
using DctBlock = std::array<std::array<float, kDctSize>, 3>;

class DctEncoder {
 public:
  /// `level`: the attribute dwaCompressionLevel. `vectors`: by the vector instructions of the processor, where it has
  /// them; the same bits without.
  explicit DctEncoder(float level, bool vectors = true);

  /// Spoils the block. Its means (brightness, two differences of colour) go to `dc`; the other cosines to `ac`, which
  /// has room for 189, zeros as their number. Returns the end of those.
  std::uint16_t* run(DctBlock& block, std::uint16_t* ac, std::array<std::uint16_t, 3>& dc) const;

 private:
  std::array<float, kDctSize> brightness_, colour_;  ///< tolerances
  bool vectors_;
};

}  // namespace afterglow
