// SPDX-License-Identifier: MIT
// In place of play_window.cpp where the program is built without a window.
#include "apps/play_window.h"

namespace afterglow {

Result<void> play_in_window(
    PlayerOptions, DeviceOptions, const PlayWindowOptions&, Console&,
    const std::function<void(const Device&, Player&, const PlayedTimes&, const Result<void>&)>&) {
  return Error{ErrorKind::usage, "this program is built without a window", "afterglow play", 0, "--headless"};
}

}  // namespace afterglow
