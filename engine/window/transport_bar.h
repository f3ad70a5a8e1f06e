// SPDX-License-Identifier: MIT
// The bar below the picture: play, step, loop, speed, zoom, and what playing says of itself, below the timeline.
#pragma once

#include <functional>
#include <string>

#include "core/geometry.h"
#include "play/transport.h"
#include "play/view.h"
#include "window/timeline.h"
#include "window/ui.h"

namespace afterglow {

/// What the bar shows and moves. References hold for one `draw`.
struct TransportBarState {
  TimelineState timeline;
  View& view;
  Size picture, window;    ///< of the picture, and of the part of the window that it has
  double fps = 0;          ///< reached; 0 while paused
  std::uint64_t late = 0;  ///< frames whose picture had not been read in time
  std::string name = {};   ///< of the picture that is shown
};

/// Within a frame of ImGui, as a window at this place. Drawing thread alone.
void draw_transport_bar(Ui& ui, TransportBarState& state, ImVec2 place, ImVec2 size);
/// What it wants when it is that wide: what finds no room in a row goes to the next.
BarShape transport_bar_shape(const Ui& ui, float width);

}  // namespace afterglow
