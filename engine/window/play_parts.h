// SPDX-License-Identifier: MIT
// Panel, transport bar and help sheet of a window that plays.
#pragma once

#include <optional>

#include "window/panel.h"
#include "window/player_port.h"
#include "window/run_window.h"

namespace afterglow {

/// Gives a WindowOptions its parts. Must outlive the run_window that uses them, and be gone before the player.
class PlayParts {
 public:
  /// `preset`, `options`: as the player's preset is loaded.
  PlayParts(Player& player, const std::filesystem::path& preset, const PresetOptions& options);
  void add_to(WindowOptions& options);

 private:
  void draw_transport(Player& player, Ui& ui, ImVec2 place, ImVec2 size) const;
  PlayerPort port_;
  PresetOptions preset_options_;
  std::optional<Panel> panel_;
};

}  // namespace afterglow
