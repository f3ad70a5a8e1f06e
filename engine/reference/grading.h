// SPDX-License-Identifier: MIT
// Colour grading in the published steps of Unity's URP (LutBuilderHdr.shader, ColorUtils.cs): white balance, channel
// mixer, split toning, shadows/midtones/highlights, lift/gamma/gain. Colours given as settings are linear.
#pragma once

#include <array>
#include <glm/vec2.hpp>

#include "reference/double_image.h"

namespace afterglow::reference {

struct WhiteBalance {
  double kelvin = 6504;
  double temperature = 0, tint = 0;  ///< −100…100
};
/// What gets negative becomes 0.
DoubleImage white_balance(const DoubleImage& source, const WhiteBalance& settings);
/// CIE 1931 x and y of a light of 2000…25000 K: a lamp's up to 2900 K, daylight from 4000 K on.
glm::dvec2 white_of_kelvin(double kelvin);

/// Percent; row i makes channel i.
using ChannelMix = std::array<std::array<double, 3>, 3>;
DoubleImage channel_mixer(const DoubleImage& source, const ChannelMix& mix);

struct SplitToning {
  Rgb shadows{0.5}, highlights{0.5};  ///< display values (sRGB-encoded)
  double balance = 0;                 ///< −100…100
};
DoubleImage split_toning(const DoubleImage& source, const SplitToning& settings);

struct ShadowsMidtonesHighlights {
  Rgb shadows{1}, midtones{1}, highlights{1};
  double shadows_offset = 0, midtones_offset = 0, highlights_offset = 0;
  double shadows_start = 0, shadows_end = 0.3, highlights_start = 0.55, highlights_end = 1;
};
DoubleImage shadows_midtones_highlights(const DoubleImage& source, const ShadowsMidtonesHighlights& settings);

struct LiftGammaGain {
  Rgb lift{1}, gamma{1}, gain{1};
  double lift_offset = 0, gamma_offset = 0, gain_offset = 0;
};
DoubleImage lift_gamma_gain(const DoubleImage& source, const LiftGammaGain& settings);

/// Light times 2^ev.
DoubleImage exposure(const DoubleImage& source, double ev);

/// ASC CDL v1.2 without the clamps to 1: (c·slope + offset)^power, saturation around Rec.709's luma.
struct Cdl {
  Rgb slope{1}, offset{0}, power{1};
  double saturation = 1;
};
DoubleImage cdl(const DoubleImage& source, const Cdl& settings);

/// Gains in stops at −6, −3, 0, 3 and 6 stops from middle grey, between them Fritsch and Butland's cubics; then hue,
/// saturation and luma by hue, at red, yellow, green, cyan, blue and magenta, between them smoothsteps.
struct Curves {
  bool by_luminance = false;
  std::array<double, 5> master{};                   ///< of all channels, or of the luminance
  std::array<std::array<double, 3>, 3> channels{};  ///< of red, green, blue: at −3, 0 and 3 stops
  std::array<Rgb, 6> hues{};                        ///< −100…100 each: 0.3 degrees, percent, percent of a stop
};
DoubleImage curves(const DoubleImage& source, const Curves& settings);

}  // namespace afterglow::reference
