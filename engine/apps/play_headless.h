// SPDX-License-Identifier: MIT
// Playing without a window: as fast as possible or by the clock, for figures and pictures.
#pragma once

#include <cstdint>
#include <optional>

#include "core/result.h"
#include "play/player.h"

namespace afterglow {

struct HeadlessOptions {
  std::optional<std::uint64_t> count;  ///< frames to show; else the range once
  bool fast = false;                   ///< every frame, whatever the clock says
};

/// Shows the first frame before the clock begins to run. Ends after so many frames, or where a range that is played
/// once ends. Errors: script (a preset without a good build), io (nothing could be read), device, interrupted.
Result<void> play_headless(Player& player, const HeadlessOptions& options);

}  // namespace afterglow
