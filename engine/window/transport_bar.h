// SPDX-License-Identifier: MIT
// The bar below the picture: play, step, scrub, range, loop, speed, and what playing says of itself.
#pragma once

#include <functional>
#include <string>

#include "play/transport.h"
#include "window/ui.h"

namespace afterglow {

/// What the bar shows and moves. References hold for one `draw`.
struct TransportBarState {
  Transport& transport;
  double now = 0;                   ///< of the player's clock
  int shown = 0;                    ///< position that is on screen; −1: none
  std::function<int(int)> number;   ///< of the frame at a position, in its sequence
  std::function<bool(int)> cached;  ///< is the picture at a position in memory?
  double fps = 0;                   ///< reached; 0 while paused
  std::uint64_t late = 0;           ///< frames whose picture had not been read in time
  std::string picture = {};         ///< name of what is shown
};

/// Within a frame of ImGui, as a window at this place. Drawing thread alone.
void draw_transport_bar(Ui& ui, TransportBarState& state, ImVec2 place, ImVec2 size);
/// Height that it wants.
float transport_bar_height(const Ui& ui);

/// The position under x in a bar that begins at `left` and is `width` wide: its frames share the width evenly.
int position_in_bar(float x, float left, float width, int frames);

}  // namespace afterglow
