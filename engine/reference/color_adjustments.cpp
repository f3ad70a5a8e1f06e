// SPDX-License-Identifier: MIT
#include "reference/color_adjustments.h"

#include <cmath>

#include "reference/color.h"

namespace afterglow::reference {

Rgb adjust_contrast(const Rgb& c, double factor) {
  Rgb out;
  for (int i = 0; i < 3; ++i) {
    const double distance = factor == 0 ? 0 : (linear_to_logc(c[i]) - kAcesccMidGray) * factor;  // not −∞ · 0
    out[i] = logc_to_linear(distance + kAcesccMidGray);
  }
  return out;
}

Rgb shift_hue(const Rgb& c, double turn) {
  Rgb hsv = rgb_to_hsv(c, kUnityHsvEpsilon);
  hsv.x = rotate_hue(hsv.x + turn);
  return hsv_to_rgb(hsv);
}

Rgb adjust_saturation(const Rgb& c, double factor) {
  const double y = luminance(c);
  return y + factor * (c - y);
}

Rgb adjust_color(Rgb c, const ColorAdjustments& settings) {
  c = glm::min(c, Rgb(60));
  if (settings.post_exposure != 0) c *= std::exp2(settings.post_exposure);
  if (settings.contrast != 0) c = adjust_contrast(c, settings.contrast / 100 + 1);
  if (settings.color_filter != Rgb(1)) c *= settings.color_filter;
  c = glm::max(c, Rgb(0));
  if (settings.hue_shift != 0) c = shift_hue(c, settings.hue_shift / 360);
  if (settings.saturation != 0) c = adjust_saturation(c, settings.saturation / 100 + 1);
  return glm::max(c, Rgb(0));
}

DoubleImage color_adjustments(const DoubleImage& source, const ColorAdjustments& settings) {
  if (settings.post_exposure == 0 && settings.contrast == 0 && settings.color_filter == Rgb(1) &&
      settings.hue_shift == 0 && settings.saturation == 0)
    return source;  // not even the clamp to 60
  return map_straight(source, [&](const Rgb& c) { return adjust_color(c, settings); });
}

}  // namespace afterglow::reference
