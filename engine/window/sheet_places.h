// SPDX-License-Identifier: MIT
// Where the sheets over the picture lie in this frame: none of those that hang from the top lies on another such, none
// of those that stand at the bottom either.
#pragma once

#include <imgui.h>

#include <vector>

namespace afterglow {

/// Drawing thread alone. Begins anew with each frame of ImGui.
class SheetPlaces {
 public:
  /// The corner of a sheet whose `pivot` (0 or 1 in each direction, or the middle) is wanted at `at`: below those that
  /// hang in its way, or above those that stand there.
  ImVec2 place(ImVec2 at, ImVec2 pivot, ImVec2 size);
  struct Room {
    float top = 0, bottom = 0;
  };
  /// What is free between `left` and `right`, of what reaches from `room.top` to `room.bottom`.
  Room free(float left, float right, Room room) const;

 private:
  struct Place {
    ImVec2 from, to;
    bool hangs = false;
  };
  void follow_frame() const;
  mutable std::vector<Place> places_;
  mutable int frame_ = -1;
};

}  // namespace afterglow
