// SPDX-License-Identifier: MIT
// The panel's edits into the preset's file, and back out of it.
#pragma once

#include <future>
#include <optional>
#include <string>
#include <vector>

#include "edit/write_back.h"
#include "window/panel_base.h"
#include "window/panel_stack.h"

namespace afterglow {

/// The changed arguments as a command takes them: "--arg strength=0.8 --arg hero=Lamp".
std::string argument_words(const SettingEdits& edits);

/// Drawing thread alone; scripts run and files are written on a thread of its own, so that playing goes on.
class PanelSave {
 public:
  /// `stack` outlives it.
  PanelSave(std::filesystem::path preset, PresetOptions options, PanelStack& stack)
      : writer_(std::move(preset), options), options_(std::move(options)), stack_(stack) {}
  /// Waits for a save that is under way.
  ~PanelSave() = default;

  const std::filesystem::path& file() const { return writer_.file(); }
  /// Begins to write the stack and all edits but those in conflict with the file. Nothing happens while another save
  /// runs, or while stack and file disagree.
  void save(PanelPort& port, const EditBases& bases);
  /// Writes the preset as it is on screen to another file, whole or not at all; its own stays as it is. Errors, also
  /// where a value cannot be written, are told by `poll`. Nothing happens while another save runs.
  void save_as(PanelPort& port, const std::filesystem::path& to);
  /// The file that `save_as` has written, if it holds all that is on screen; once.
  std::optional<std::filesystem::path> take_copy() { return std::exchange(copy_, std::nullopt); }
  /// The file as it was before the last save; what was written then stands over it as edits again.
  void undo(PanelPort& port, EditBases& bases);
  bool can_undo() const { return !busy() && writer_.saves() > 0; }
  bool busy() const { return running_.valid(); }
  /// Something is written, and not on screen yet.
  bool settling() const { return !settling_.empty(); }
  /// This value is.
  bool settles(const SettingEdit& edit) const;
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
    std::optional<std::filesystem::path> copy = {};
  };
  Outcome write(const std::vector<PresetEdit>& edits, const std::optional<WorkingText>& working);
  Outcome write_copy(const std::vector<PresetEdit>& edits, const std::optional<WorkingText>& working,
                     const std::filesystem::path& to) const;
  void take_saved(PanelPort& port, EditBases& bases, Rewrite rewrite);
  void tell(std::string message, bool failed);
  void settle(PanelPort& port, EditBases& bases);
  void forget_refused(const SettingEdits& edits);

  PresetWriter writer_;
  PresetOptions options_;
  PanelStack& stack_;
  StackText saving_stack_;  // what the running save writes; null: the stack is the file's
  std::optional<std::filesystem::path> copy_;
  struct Edited {
    std::vector<SettingEdit> edits;
    StackText text;
    bool operator==(const Edited&) const = default;
  };
  Edited copied_;  ///< what the copy that is written holds
  struct SavedText {
    std::string before, after;
    bool stack = false;  // a changed one went into it
  };
  std::vector<SavedText> texts_;                  // of each save that can be taken back
  std::vector<BaseChange> saving_;                // what the running save writes
  std::vector<RefusedSetting> held_back_;         // in conflict with the file
  std::vector<std::vector<BaseChange>> written_;  // by each save that can be taken back
  std::vector<BaseChange> settling_;              // written, and still edits until the new file is shown
  std::uint64_t generation_ = 0;                  // of the stack that was shown when they were written
  std::string message_;
  bool failed_ = false;
  std::vector<RefusedSetting> refused_;
  std::vector<std::string> notes_;
  std::future<Outcome> running_;  // last: it ends before what it uses goes
};

}  // namespace afterglow
