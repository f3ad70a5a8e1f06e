// SPDX-License-Identifier: MIT
// All frames as a bar: what is shown, the range, what is in memory, what is missing or cannot be read, clips and
// markers; numbers stand over it. Scrubs.
#pragma once

#include <functional>

#include "play/player.h"
#include "window/markers.h"
#include "window/ui.h"

namespace afterglow {

/// References hold for one `draw`.
struct TimelineState {
  Transport& transport;
  double now = 0;                        ///< of the player's clock
  int shown = 0;                         ///< position that is on screen; −1: none
  std::function<int(int)> number;        ///< of the frame at a position, in its sequence
  std::function<FrameState(int)> state;  ///< of the frame at a position
  const Footage& footage;
  const Markers& markers;  ///< that follow `footage`
};

/// As wide as the window of ImGui that it is drawn into.
void draw_timeline(const Ui& ui, TimelineState& state);
float timeline_height(const Ui& ui);

/// The position under x in a bar that begins at `left` and is `width` wide: its frames share the width evenly.
int position_in_bar(float x, float left, float width, int frames);

}  // namespace afterglow
