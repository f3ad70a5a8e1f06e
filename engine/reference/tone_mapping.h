// SPDX-License-Identifier: MIT
// Tone curves (math.md §6): scene-linear light into display range. Alpha is kept; nothing is clamped to 1.
#pragma once

#include "reference/double_image.h"

namespace afterglow::reference {

enum class ToneMode { none, aces, neutral, reinhard, reinhard_extended, agx, khronos_neutral, hable, gt };
enum class AgxLook { base, punchy, golden };

struct ToneMapping {
  ToneMode mode = ToneMode::aces;
  double exposure = 0;      ///< EV, before the curve
  double white = 8;         ///< reinhard_extended, hable: becomes 1
  bool full_white = false;  ///< aces, reinhard: light of 60 becomes 1
  AgxLook look = AgxLook::base;
  double toe = 0.25, toe_length = 0.5, shoulder_length = 0.6, shoulder_angle = 0.2;  ///< hable
};

/// The curves alone, without the clamp that the pass puts before them: to 60 in the first three, to 65504 in the
/// others.
Rgb tone_reinhard(const Rgb& x);
/// Hable's curve with Unity's neutral constants; white at 5.3.
Rgb tone_neutral(const Rgb& x);
/// Fitted ACES (RRT and ODT as one rational curve per channel, with glow, red modifier and dim surround). x ≥ 0.
Rgb tone_aces(const Rgb& x);

/// On luminance; `white` becomes 1.
Rgb tone_reinhard_extended(const Rgb& x, double white);
/// Matrices, logarithm, sigmoid, look, and back, in their published steps.
Rgb tone_agx(const Rgb& x, AgxLook look);
Rgb tone_khronos_neutral(const Rgb& x);
/// Piecewise power curves from Hable's user parameters.
Rgb tone_hable(const Rgb& x, const ToneMapping& settings);
/// Uchimura's curve with P = 1, a = 1, m = 0.22, l = 0.4, c = 1.33, b = 0.
Rgb tone_gt(const Rgb& x);

/// One colour through the whole pass: exposure, clamp, then the curve; `none` leaves c as it is.
Rgb tone_map(const Rgb& c, const ToneMapping& settings);
Rgb tone_map(const Rgb& c, ToneMode mode);
DoubleImage tone_mapping(const DoubleImage& source, const ToneMapping& settings);
DoubleImage tone_mapping(const DoubleImage& source, ToneMode mode);

}  // namespace afterglow::reference
