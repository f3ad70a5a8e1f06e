// SPDX-License-Identifier: MIT
// Events that wait for a frame of the interface. A frame sees where the pointer is and which buttons are down once: a
// press behind which the pointer has moved on would be taken for one at the later place, and a press and release in one
// frame for nothing. So a frame gets as much as it can tell apart, and the rest waits for the next ones.
#pragma once

#include <deque>
#include <optional>

#include "window/input_event.h"

namespace afterglow {

/// Not thread-safe.
class InputQueue {
 public:
  void push(const InputEvent& event) { events_.push_back(event); }
  bool empty() const { return events_.empty(); }
  /// The next event that the frame under way can take besides those it has; none: it has all it can. `typing`: keys go
  /// to a text field, which needs them apart from the text.
  std::optional<InputEvent> next(bool typing);
  /// The frame has been drawn: the next one begins.
  void frame_done() { frame_ = {}; }

 private:
  bool fits(const InputEvent& event, bool typing) const;
  struct Frame {
    unsigned buttons = 0;  ///< that changed
    bool wheel = false, text = false;
    bool special_key = false, special_up = false;  ///< pressed, let go: a key that is both in one frame is neither
  };
  std::deque<InputEvent> events_;
  Frame frame_;
};

}  // namespace afterglow
