// SPDX-License-Identifier: MIT
// Which of the frames that are played begin a shot, so that looks do not carry one shot into the next.
#pragma once

#include <optional>

#include "play/footage.h"

namespace afterglow {

/// Used from one thread.
class ShotWatch {
 public:
  explicit ShotWatch(Cuts cuts) : cuts_(std::move(cuts)) {}

  /// Whether the frame at `position` is of another shot than the one that was shown last. Of that one itself: as it was
  /// said before.
  bool begins(const Footage& footage, int position, const Picture& picture);
  /// The frame that was asked for last is on screen now.
  void shown() { shown_ = asked_; }

 private:
  struct Frame {
    std::string clip;
    int place = 0;      ///< its number in the clip
    int number = 0;     ///< that of the picture, where a missing one is held
    ShotSketch sketch;  ///< of the last picture of its shot that is not blank
    bool begins = false;
  };
  std::optional<Frame> shown_, asked_;
  Cuts cuts_;
};

}  // namespace afterglow
