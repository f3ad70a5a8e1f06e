// SPDX-License-Identifier: MIT
// Panel, transport bar and help sheet of a window that plays.
#pragma once

#include <atomic>
#include <memory>
#include <optional>

#include "window/frame_export.h"
#include "window/mark_keys.h"
#include "window/panel.h"
#include "window/player_port.h"
#include "window/preset_browser.h"
#include "window/range_export.h"
#include "window/run_window.h"

namespace afterglow {

/// Gives a WindowOptions its parts. Must outlive the run_window that uses them, and be gone before the player.
class PlayParts {
 public:
  /// `setup`: as the player's preset is loaded, and where frames are written (FrameExport, RangeExport).
  PlayParts(Player& player, const ExportSetup& setup, Diagnostics& diagnostics);
  void add_to(WindowOptions& options);

 private:
  void draw_transport(Player& player, Ui& ui, ImVec2 place, ImVec2 size);
  bool edit_stack(Ui& ui, Action action);
  void ask_for_range(Ui& ui);
  void draw_dialogs(Ui& ui);
  std::string unsaved();
  void draw_panel(Ui& ui, ImVec2 place, ImVec2 size);
  Player& player_;
  PlayerPort port_;
  PresetOptions preset_options_;
  std::optional<Panel> panel_;
  FrameExport export_;
  RangeExport range_export_;
  NameDialog range_name_;
  MarkKeys marks_;
  PresetBrowser presets_;
  ThumbnailFrame thumbnail_frame() const;
  void open_panel(const std::filesystem::path& preset);
  EffectBrowser::Source effect_pictures();
  void follow_thumbnails();
  void browse_presets();
  void draw_presets(Ui& ui);
  std::filesystem::path preset_;  ///< that is played
  int thumbnails_of_ = -1;        ///< position of the frame that they are of
  bool thumbnails_seen_ = false;  ///< a list that shows them is open
  std::atomic<bool> news_ = false;
  std::unique_ptr<Thumbnails> thumbnails_;  // last: its thread says `news_`
};

}  // namespace afterglow
