// SPDX-License-Identifier: MIT
// Which frames of a timeline have a tick, and which of these a number. Arithmetic alone.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "play/footage.h"

namespace afterglow {

struct RulerTick {
  float x = 0;        ///< of the frame's middle, from the bar's left end
  std::string label;  ///< its number; empty: a small tick
  float label_x = 0;  ///< where the label begins
};

struct RulerSpace {
  float width = 0;                                         ///< of the bar, in pixels
  float gap = 0;                                           ///< at least this much between labels
  float least_tick = 0;                                    ///< and between ticks
  std::function<float(const std::string&)> width_of = {};  ///< of a label
};

/// Numbers are multiples of 1, 2 or 5 times a power of ten, ticks five (or two) times as dense. No label overlaps
/// another or leaves the bar. Each clip counts for itself.
std::vector<RulerTick> ruler_ticks(const Footage& footage, const RulerSpace& space);

}  // namespace afterglow
