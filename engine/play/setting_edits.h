// SPDX-License-Identifier: MIT
// What the panel has changed: settings over those of the preset, with undo and redo. Plain data.
#pragma once

#include <optional>
#include <string>
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

/// Not thread-safe.
class SettingEdits {
 public:
  /// Changes a setting. Changes of the same setting within one gesture (a drag of a slider) are one step of undo.
  void set(const std::string& entry, const std::string& setting, const SettingValue& value);
  /// The preset's value again. False when it was not changed.
  bool reset(const std::string& entry, const std::string& setting);
  bool reset_entry(const std::string& entry);
  bool reset_all();
  /// The next change begins a new step, even of the same setting.
  void end_gesture() { open_.clear(); }

  bool can_undo() const { return at_ > 0; }
  bool can_redo() const { return at_ + 1 < history_.size(); }
  bool undo();  ///< false: there is nothing to undo
  bool redo();

  /// The preset was saved with edits in it, or a save was taken back: every step of the history stays what it was on
  /// screen. Steps that had the value from before get it as an edit; those that say what the preset says now need none.
  void rebase(const std::vector<BaseChange>& changes);

  /// In the order in which they were first made.
  const std::vector<SettingEdit>& edits() const { return history_[at_]; }
  std::optional<SettingValue> value(const std::string& entry, const std::string& setting) const;
  /// For LiveStack::set_overrides: those of the command line, then these.
  std::vector<Override> overrides(const std::vector<Override>& given) const;
  /// The same for arguments of the preset.
  std::vector<ArgumentValue> arguments(const std::vector<ArgumentValue>& given) const;

 private:
  bool take(std::vector<SettingEdit> edits, const std::string& gesture);
  std::vector<std::vector<SettingEdit>> history_{{}};
  std::size_t at_ = 0;
  std::string open_;  ///< the setting that the present gesture changes
};

}  // namespace afterglow
