// SPDX-License-Identifier: MIT
// The panel's edits into the preset's file, and back out of it.
#pragma once

#include <future>
#include <optional>
#include <string>
#include <vector>

#include "edit/write_back.h"
#include "window/panel_base.h"

namespace afterglow {

/// The changed arguments as a command takes them: "--arg strength=0.8 --arg hero=Lamp".
std::string argument_words(const SettingEdits& edits);

/// Drawing thread alone; scripts run and files are written on a thread of its own, so that playing goes on.
class PanelSave {
 public:
  PanelSave(std::filesystem::path preset, PresetOptions options) : writer_(std::move(preset), std::move(options)) {}
  /// Waits for a save that is under way.
  ~PanelSave() = default;

  const std::filesystem::path& file() const { return writer_.file(); }
  /// Begins to write all edits but those in conflict with the file. Nothing happens while another save runs.
  void save(PanelPort& port, const EditBases& bases);
  /// The file as it was before the last save; what was written then stands over it as edits again.
  void undo(PanelPort& port, EditBases& bases);
  bool can_undo() const { return !busy() && writer_.saves() > 0; }
  bool busy() const { return running_.valid(); }
  /// Written, and not on screen yet.
  bool settling() const { return !settling_.empty(); }
  /// Takes what has come of a save; to be called in every turn. True when there is something new to tell.
  bool poll(PanelPort& port, EditBases& bases);
  /// Blocks until `poll` has something to take. For tests.
  void wait() const {
    if (running_.valid()) running_.wait();
  }

  /// Of the last save or undo: "3 settings written to look.lua"; the error when it failed.
  const std::string& message() const { return message_; }
  bool failed() const { return failed_; }
  /// What the last save left out, with the reason, and what it wants to be known.
  const std::vector<RefusedSetting>& refused() const { return refused_; }
  const std::vector<std::string>& notes() const { return notes_; }
  void dismiss();

 private:
  struct Outcome {
    std::optional<Error> error;
    Rewrite rewrite;
  };
  void tell(std::string message, bool failed);
  void forget_what_is_in_the_file(PanelPort& port, EditBases& bases);

  PresetWriter writer_;
  std::vector<BaseChange> saving_;                // what the running save writes
  std::vector<RefusedSetting> held_back_;         // in conflict with the file
  std::vector<std::vector<BaseChange>> written_;  // by each save that can be taken back
  std::vector<BaseChange> settling_;              // written, and still edits until the new file is shown
  std::string message_;
  bool failed_ = false;
  std::vector<RefusedSetting> refused_;
  std::vector<std::string> notes_;
  std::future<Outcome> running_;  // last: it ends before what it uses goes
};

}  // namespace afterglow
