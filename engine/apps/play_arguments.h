// SPDX-License-Identifier: MIT
// The options of `afterglow play`, declared and understood.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "apps/display_arguments.h"
#include "apps/options.h"
#include "play/player.h"

namespace afterglow {

struct PlayArguments {
  PresetArguments preset;
  DeviceArguments device;
  ExecutionArguments execution;
  std::vector<std::string> inputs;
  LayerArguments layers;
  DisplayArguments shown_on;
  std::string frames, cuts;
  std::string geometry;
  std::string other, show, loop, cache = "2G", proxy = "1", screenshot, report, exports;
  std::optional<double> fps;
  double speed = 1, volume = 100;
  int readers = static_cast<int>(std::clamp(std::thread::hardware_concurrency() / 2, 2u, 8u));
  std::uint64_t count = 0;
  bool full_screen = false, paused = false, mute = false;
  std::optional<double> ui_scale;
  bool headless = false, fast = false, real_time = false, stats = false, poll = false;

  void add(CLI::App& command);
  /// Errors: usage (options that exclude each other, formats that --screenshot cannot have), script (no such preset).
  Result<PlayerOptions> player() const;
  /// Is the image of --show there? Once the player has a build. Errors: usage.
  Result<void> check_shown(Player& player) const;

 private:
  void add_input(CLI::App& command);
  void add_playing(CLI::App& command);
  Result<void> check() const;
};

}  // namespace afterglow
