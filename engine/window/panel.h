// SPDX-License-Identifier: MIT
// The settings panel: everything that the effects of the stack declare, with what becomes of them; how the picture is
// looked at; writing back.
#pragma once

#include <array>
#include <string>

#include "window/panel_save.h"
#include "window/ui.h"

namespace afterglow {

/// Drawing thread alone; needs a Dear ImGui context and nothing of a window.
class Panel {
 public:
  /// `options`: as the preset is loaded, without the panel's edits.
  Panel(std::filesystem::path preset, PresetOptions options) : save_(std::move(preset), std::move(options)) {}

  /// Within a frame of ImGui, as a window at this place. Not called while it is hidden; `turn` then is.
  void draw(Ui& ui, PanelPort& port, ImVec2 place, ImVec2 size);
  /// Takes what has come of a save. Part of `draw`.
  void turn(Ui& ui, PanelPort& port);

  // What keys do too.
  void save(PanelPort& port) { save_.save(port, bases_); }
  void undo_save(PanelPort& port) { save_.undo(port, bases_); }
  /// The cursor goes into the search field with the next draw.
  void search() { focus_search_ = true; }

  /// What has been changed and is not in the file: "2 settings of look.lua". Empty: nothing.
  std::string unsaved(PanelPort& port) const;
  const PanelSave& saving() const { return save_; }

 private:
  void draw_head(Ui& ui, PanelPort& port);
  void draw_outcome(Ui& ui);
  void draw_settings(Ui& ui, PanelPort& port);
  void draw_arguments(Ui& ui, PanelPort& port);
  void draw_entries(Ui& ui, PanelPort& port);
  void draw_entry(Ui& ui, PanelPort& port, std::size_t index);
  bool draw_entry_head(Ui& ui, PanelPort& port, const StackEntry& entry, const std::string* skipped);
  bool found(const std::string& text) const;

  PanelSave save_;
  EditBases bases_;
  std::array<char, 64> search_{};
  bool focus_search_ = false;
};

/// Milliseconds that the passes of an entry took; a kernel that several effects share counts evenly for each. Negative:
/// not known.
double cost_of(const std::string& entry, const std::vector<KernelTime>& times);

}  // namespace afterglow
