// SPDX-License-Identifier: MIT
// What the panel has changed: the stack, and settings over those of the preset, with undo and redo. Plain data.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "script/preset.h"

namespace afterglow {

/// One setting of one entry (StackEntry::name), or an argument of the preset (no entry), with the value that stands
/// over the one it had.
struct SettingEdit {
  std::string entry, setting;
  SettingValue value;
  friend bool operator==(const SettingEdit&, const SettingEdit&) = default;
};

/// The preset itself says another value for a setting than before.
struct BaseChange {
  std::string entry, setting;
  SettingValue before, after;
};

/// The text of a preset whose stack was changed; null: as its file is.
using StackText = std::shared_ptr<const std::string>;

/// A changed stack, and what became of the entries that settings were changed of.
struct StackChange {
  StackText text;
  std::vector<std::pair<std::string, std::string>> renamed;  ///< before and now, of all that are still there
  std::string copied, copy;  ///< an entry (its name now), and the one that gets its changed settings too; or empty
};

/// The text of the file has become another.
struct TextChange {
  std::string before, after;
  StackText written;  ///< the changed stack that went into `after`, or null
};

/// Not thread-safe.
class SettingEdits {
 public:
  /// Changes a setting. Changes of the same setting within one gesture (a drag of a slider) are one step of undo.
  void set(const std::string& entry, const std::string& setting, const SettingValue& value);
  /// Several as one step.
  void set_all(const std::vector<SettingEdit>& values);
  /// One step.
  void set_stack(const StackChange& change);
  /// The stack as the file has it; settings stay. False when it was not changed.
  bool reset_stack();
  /// The preset's value again. False when it was not changed.
  bool reset(const std::string& entry, const std::string& setting);
  bool reset_all();
  /// The next change begins a new step, even of the same setting.
  void end_gesture() { open_.clear(); }

  static constexpr int kSnapshots = 3;
  /// Keeps stack and settings as they are now under a number, 0…kSnapshots − 1.
  void keep(int snapshot) { snapshots_[static_cast<std::size_t>(snapshot)] = history_[at_]; }
  bool has(int snapshot) const { return snapshots_[static_cast<std::size_t>(snapshot)].has_value(); }
  /// Everything as it was kept, as one step. False when nothing was kept, or it is so already.
  bool recall(int snapshot);

  bool can_undo() const { return at_ > 0; }
  bool can_redo() const { return at_ + 1 < history_.size(); }
  bool undo();  ///< false: there is nothing to undo
  bool redo();
  /// The last step, as if it had never been. False: there is none.
  bool take_back();

  /// The preset was saved with edits in it, or a save was taken back: every step of the history, and every snapshot,
  /// stays what it was on screen. Steps that had the value from before get it as an edit; those that say what the
  /// preset says now need none.
  void rebase(const std::vector<BaseChange>& changes);
  /// The same where stacks went into the file, or come out of it: steps that were as the file was keep its old text.
  void rebase(const std::vector<BaseChange>& changes, const TextChange& text);

  /// In the order in which they were first made.
  const std::vector<SettingEdit>& edits() const { return history_[at_].edits; }
  const StackText& stack_text() const { return history_[at_].text; }
  bool none() const { return edits().empty() && !stack_text(); }
  std::optional<SettingValue> value(const std::string& entry, const std::string& setting) const;
  /// For LiveStack::set_overrides: those of the command line, then these.
  std::vector<Override> overrides(const std::vector<Override>& given) const;
  /// The same for arguments of the preset.
  std::vector<ArgumentValue> arguments(const std::vector<ArgumentValue>& given) const;

 private:
  struct Step {
    std::vector<SettingEdit> edits;
    StackText text;
    friend bool operator==(const Step&, const Step&) = default;
  };
  bool take(Step step, const std::string& gesture);
  static void set(std::vector<SettingEdit>& edits, const SettingEdit& value);
  static void rebase(std::vector<SettingEdit>& edits, const std::vector<BaseChange>& changes);
  /// Steps of the history, and snapshots.
  template <class Change>
  void for_all_steps(Change&& change);
  std::vector<Step> history_{Step{}};
  std::array<std::optional<Step>, kSnapshots> snapshots_;
  std::size_t at_ = 0;
  std::string open_;  ///< the setting that the present gesture changes
};

}  // namespace afterglow
