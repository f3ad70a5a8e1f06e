// SPDX-License-Identifier: MIT
// The panel: the stack and everything that its effects declare, with what becomes of them; how the picture is looked
// at; writing back.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "window/effect_browser.h"
#include "window/name_dialog.h"
#include "window/panel_save.h"
#include "window/panel_stack.h"
#include "window/ui.h"

namespace afterglow {

/// Drawing thread alone; needs a Dear ImGui context and nothing of a window.
class Panel {
 public:
  /// `options`: as the preset is loaded, without the panel's edits.
  Panel(const std::filesystem::path& preset, const PresetOptions& options)
      : stack_(preset, options), save_(preset, options, stack_) {}

  /// Within a frame of ImGui, as a window at this place. Not called while it is hidden; `turn` then is.
  void draw(Ui& ui, PanelPort& port, ImVec2 place, ImVec2 size);
  /// Takes what has come of a save. Part of `draw`.
  void turn(Ui& ui, PanelPort& port);

  /// Called when effects are about to be listed: where their pictures come from.
  void set_pictures(std::function<EffectBrowser::Source()> pictures) { pictures_ = std::move(pictures); }
  bool lists_effects() const { return browser_.is_open(); }

  // What keys do too.
  /// True: the preset is not to be written over, and a name for a copy is asked for; see keeper_of.
  bool save(PanelPort& port);
  void undo_save(Ui& ui, PanelPort& port);
  /// The cursor goes into the search field with the next draw.
  void search() { focus_search_ = true; }
  void add_effect(PanelPort& port);  ///< asks which
  void save_as();                    ///< asks where
  /// What is done to the entry that is chosen; says so where none is.
  enum class EntryAction { remove, duplicate, earlier, later, toggle, copy, paste };
  void act(Ui& ui, PanelPort& port, EntryAction action);
  /// The entry behind the one that is chosen, or before it.
  void choose_next(Ui& ui, PanelPort& port, int by);
  const std::string& chosen() const { return chosen_; }
  /// Closes what is open over the picture; false: nothing was.
  bool close_windows();

  /// What has been changed and is not in the file: "2 settings of look.lua". Empty: nothing.
  std::string unsaved(PanelPort& port) const;
  const PanelSave& saving() const { return save_; }
  bool busy() const { return save_.busy() || save_waits_ || copy_due_.has_value(); }
  bool asks_for_name() const { return save_as_.is_open(); }
  const PanelStack& stack() const { return stack_; }

 private:
  void draw_head(Ui& ui, PanelPort& port);
  void draw_outcome(Ui& ui, PanelPort& port);
  void draw_conflict(const Ui& ui, PanelPort& port);
  void draw_choice(const Ui& ui, PanelPort& port);
  std::string conflict_text() const;
  void draw_windows(Ui& ui);
  void draw_settings(Ui& ui, PanelPort& port);
  void draw_arguments(Ui& ui, PanelPort& port);
  void draw_entries(Ui& ui, PanelPort& port);
  void act_when_built(Ui& ui, PanelPort& port);
  void draw_entry(Ui& ui, PanelPort& port, std::size_t index);
  static void draw_lost(const Ui& ui, PanelPort& port, const Build& build);
  bool draw_entry_head(Ui& ui, PanelPort& port, const StackEntry& entry, const std::string* skipped);
  struct EntryEnd;
  EntryEnd entry_end(const Ui& ui, PanelPort& port, const StackEntry& entry, bool skipped) const;
  void draw_entry_end(Ui& ui, PanelPort& port, const StackEntry& entry, const EntryEnd& end);
  void draw_entry_menu(Ui& ui, PanelPort& port, const StackEntry& entry);
  void draw_mask_menu(const StackEntry& entry);
  const StackEntry* entry_named(PanelPort& port, const std::string& name) const;
  void copy_settings(Ui& ui, PanelPort& port, const StackEntry& entry);
  void paste_settings(Ui& ui, PanelPort& port, const StackEntry& entry);
  void read_library(PanelPort& port);
  bool found(const std::string& text) const;

  PanelStack stack_;
  PanelSave save_;  // uses it
  EffectLibrary library_;
  EffectBrowser browser_;
  std::function<EffectBrowser::Source()> pictures_ = [] { return EffectBrowser::Source(); };
  NameDialog save_as_;
  bool save_waits_ = false;                        ///< for changes of the stack
  std::optional<std::filesystem::path> copy_due_;  ///< where "Save as" is to write when no save runs
  bool conflict_told_ = false;
  StackText text_;       ///< that the bases are of
  std::string chosen_;   ///< the entry that keys are about
  std::string removed_;  ///< the one before, until it is gone
  struct ActDue {
    EntryAction action;
    std::string entry;
    double since = 0;  ///< seconds of Ui::now without a build
  };
  std::optional<ActDue> act_due_;  ///< on an entry that is not built yet
  bool scroll_to_chosen_ = false;
  struct {
    std::string effect;
    std::vector<SettingEdit> values;  ///< of all settings
  } copied_;
  EditBases bases_;
  std::array<char, 64> search_{};
  bool focus_search_ = false;
};

/// Milliseconds that the passes of an entry took; a kernel that several effects share counts evenly for each. Negative:
/// not known.
double cost_of(const std::string& entry, const std::vector<KernelTime>& times);

}  // namespace afterglow
