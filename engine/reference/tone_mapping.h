// Tone curves (math.md §6): scene-linear light into display range. Alpha is kept; nothing is clamped to 1.
#pragma once

#include "reference/double_image.h"

namespace afterglow::reference {

enum class ToneMode { none, aces, neutral, reinhard };

/// The curves alone, without the clamp to 60 that the pass puts before them.
Rgb tone_reinhard(const Rgb& x);
/// Hable's curve with Unity's neutral constants; white at 5.3.
Rgb tone_neutral(const Rgb& x);
/// Fitted ACES (RRT and ODT as one rational curve per channel, with glow, red modifier and dim surround). x ≥ 0.
Rgb tone_aces(const Rgb& x);

/// One colour through the whole pass: min(c, 60), then the curve; `none` leaves c as it is.
Rgb tone_map(const Rgb& c, ToneMode mode);
DoubleImage tone_mapping(const DoubleImage& source, ToneMode mode);

}  // namespace afterglow::reference
