// SPDX-License-Identifier: MIT
// What playing has to say for itself: --stats as text, --report as JSON.
#pragma once

#include <optional>
#include <string>

#include "play/player.h"

namespace afterglow {

struct PlayReport {
  std::string preset, device, driver;
  std::string mode;            ///< "real time" or "fast"
  double startup = 0;          ///< milliseconds until playing began
  double wall = 0;             ///< milliseconds of playing
  std::optional<Error> error;  ///< that playing ended with
};

std::string play_report_text(const PlayReport& report, Player& player);
std::string play_report_json(const PlayReport& report, Player& player);
/// Of what failed, or was interrupted, before anything was played.
std::string play_failure_json(const std::string& preset, const Error& error);

}  // namespace afterglow
