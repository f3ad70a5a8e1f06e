// SPDX-License-Identifier: MIT
// Playing in a window.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "apps/console.h"
#include "apps/window_place.h"
#include "gpu/device.h"
#include "image/display_table.h"
#include "play/player.h"

namespace afterglow {

struct PlayWindowOptions {
  std::optional<WindowPlace> place;  ///< none: as the last window was left
  std::optional<double> scale;       ///< of the interface; none: the desktop's
  bool full_screen = false;
  bool paused = false;
  bool stats = false;
  double speed = 1;
  std::optional<ShownDisplay> display;  ///< that pictures are shown on; none: sRGB
  /// Makes it anew, or another display and view of its configuration. Called on a thread of its own.
  std::function<Result<ShownDisplay>(const std::string& display, const std::string& view)> make_display;
  std::filesystem::path exports;  ///< see FrameExport; empty: beside where the program was called
};

/// In milliseconds.
struct PlayedTimes {
  double startup = 0;  ///< until the window's loop began
  double wall = 0;     ///< from there
};

/// Until the window is closed. `at_end` sees the player before it goes, and what came of it, also when that is a
/// display that is lost, with which the process ends. Errors: usage, io (footage), device (no display, none that can
/// show pictures in it, lost), interrupted.
Result<void> play_in_window(
    PlayerOptions player, DeviceOptions device, const PlayWindowOptions& options, Console& console,
    const std::function<void(const Device&, Player&, const PlayedTimes&, const Result<void>& done)>& at_end);

}  // namespace afterglow
