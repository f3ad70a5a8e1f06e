// SPDX-License-Identifier: MIT
// Pictures follow the sound that is heard: the transport is held to its clock, and what moves the transport moves the
// sound.
#pragma once

#include <optional>

#include "play/footage.h"
#include "play/sound.h"
#include "play/transport.h"

namespace afterglow {

/// Seconds of a video's own time at a part of a frame's turn (0…1), where `fps` turns come a second. None: it is no
/// video, or its frames do not come at the file's rate (some of them were chosen, another rate).
std::optional<double> sound_moment(const Footage& footage, int position, double fraction, double fps);

/// Not thread-safe.
class SoundFollower {
 public:
  /// Once a turn, before the due frame is asked for. There is sound while the transport plays forwards by the clock at
  /// speed 1. `now`: of the transport's clock, which is the sound's.
  void follow(Transport& transport, const Footage& footage, Sound& sound, double now);

 private:
  /// What was so in the last turn.
  struct Before {
    const Movie* movie = nullptr;
    double place = 0, at = 0;  ///< frames of the row, with parts of them; when
  };
  std::optional<Before> before_;
};

}  // namespace afterglow
