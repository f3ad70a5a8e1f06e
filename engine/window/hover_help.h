// SPDX-License-Identifier: MIT
// When the words about an item are shown: while the pointer rests on it, and never while something is dragged.
#pragma once

#include <imgui.h>

#include <limits>

namespace afterglow {

class HoverHelp {
 public:
  static constexpr double kRest = 0.5;  ///< seconds

  /// Asked in each frame for the item under the pointer. `item`: where it lies. `held`: a button of the mouse is down.
  /// Once shown, the words stay until the pointer leaves.
  bool due(ImVec2 item, ImVec2 pointer, bool held, double now) {
    const bool other = item.x != item_.x || item.y != item_.y;
    const bool moved = pointer.x != pointer_.x || pointer.y != pointer_.y;
    if (other || held) shown_ = false;
    if (other || held || (moved && !shown_)) since_ = now;
    item_ = item;
    pointer_ = pointer;
    asked_ = true;
    if (!held && now >= since_ + kRest) shown_ = true;
    if (!held && !shown_) wake_ = since_ + kRest;
    return shown_;
  }
  void begin_frame() {
    if (!asked_) item_ = {-1, -1};
    asked_ = false;
    wake_ = std::numeric_limits<double>::infinity();
  }
  /// When words that were asked for in this frame are due; infinity: there are none to wait for.
  double wake() const { return wake_; }

 private:
  ImVec2 item_{-1, -1}, pointer_{-1, -1};
  double since_ = 0, wake_ = std::numeric_limits<double>::infinity();
  bool shown_ = false, asked_ = false;
};

}  // namespace afterglow
