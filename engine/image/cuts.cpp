// SPDX-License-Identifier: MIT
#include "image/cuts.h"

#include <algorithm>

#include "image/sequence.h"

namespace afterglow {

bool Cuts::between(int before, int frame) const {
  if (by == By::each) return before < frame;
  const auto next = std::ranges::upper_bound(frames, before);
  return next != frames.end() && *next <= frame;
}

Result<Cuts> parse_cuts(const std::string& text) {
  if (text == "auto") return Cuts{.by = Cuts::By::pictures};
  if (text == "all") return Cuts{.by = Cuts::By::each};
  Cuts out{.by = Cuts::By::frames};
  if (text == "none") return out;
  auto frames = parse_frames(text);
  if (!frames)
    return Error{ErrorKind::usage, frames.error().message, "--cuts", 0,
                 "auto, all, none, or frames that begin a shot: 25,49"};
  out.frames = std::move(*frames);
  std::ranges::sort(out.frames);
  return out;
}

}  // namespace afterglow
