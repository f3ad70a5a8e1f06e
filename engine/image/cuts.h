// SPDX-License-Identifier: MIT
// Where shots begin, within one sequence or video: told by numbers of frames, or found by looking (shot.h).
#pragma once

#include <string>
#include <vector>

#include "core/result.h"
#include "image/shot.h"

namespace afterglow {

struct Cuts {
  /// What says where: pictures of videos, pictures of whatever comes, `frames` alone, or nothing: each frame is a shot.
  enum class By { videos, pictures, frames, each };
  By by = By::videos;
  std::vector<int> frames{};  ///< that begin a shot, rising

  /// Whether pictures are to be looked at.
  bool looks(bool of_video) const { return by == By::pictures || (by == By::videos && of_video); }
  /// Whether a frame behind `before`, up to `frame`, is told to begin a shot.
  bool between(int before, int frame) const;
};

/// "auto": By::pictures; "all": By::each; "none"; else numbers as for --frames: "25,49". Errors: usage.
Result<Cuts> parse_cuts(const std::string& text);

}  // namespace afterglow
