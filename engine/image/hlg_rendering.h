// SPDX-License-Identifier: MIT
// What lies between the light of a scene and that of a display that shows its HLG: the OOTF of ITU-R BT.2100, table 5.
#pragma once

#include <algorithm>
#include <cmath>

namespace afterglow {

/// γ of a display of 1000 cd/m²; the colours that are multiplied are of Rec.2020.
inline constexpr double kHlgGamma = 1.2;

inline double hlg_luminance(const float* rgb) {
  return 0.2627 * static_cast<double>(rgb[0]) + 0.6780 * static_cast<double>(rgb[1]) +
         0.0593 * static_cast<double>(rgb[2]);
}

/// Colours times a power of their luminance, in place; black where there is none. Components below 0 count as 0.
inline void times_power_of_luminance(double exponent, float* rgb) {
  for (int c = 0; c < 3; ++c) rgb[c] = std::clamp(rgb[c], 0.0f, 1e30f);
  const double luminance = hlg_luminance(rgb);
  const double factor = luminance > 0 ? std::pow(luminance, exponent) : 0;
  for (int c = 0; c < 3; ++c) rgb[c] = static_cast<float>(static_cast<double>(rgb[c]) * factor);
}

/// Light of the scene, in units whose power γ is that of the display, to the display's, and back.
inline void hlg_to_display(float* rgb) { times_power_of_luminance(kHlgGamma - 1, rgb); }
inline void hlg_to_scene(float* rgb) { times_power_of_luminance(1 / kHlgGamma - 1, rgb); }

}  // namespace afterglow
