// SPDX-License-Identifier: MIT
// Changed settings go back into the text of the preset that they came from: in place, with its comments, layout and
// everything else kept byte for byte. What a script computes is never overwritten; it is refused with its place and
// expression. Nothing is written unless the new text, run, gives exactly the wanted settings and all others as before.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "script/preset.h"

namespace afterglow {

/// One wanted change.
struct PresetEdit {
  std::string entry;    ///< its name in the stack: "glow#2"
  std::string setting;  ///< of its effect; or "enabled", "order" (integer), "at" (enumeration) of the entry
  /// Nothing: back to the default. A key that was written is removed; where comments stand around it, or where the
  /// value would still not be the default (a preset that extends another), the default is written in its place.
  std::optional<SettingValue> value = {};
  std::string volume = {};  ///< not empty: the value that this volume has for the setting, not the entry's own

  std::string name() const;  ///< "glow.knee", "cave: glow.knee"
};

/// Edits from `ENTRY.SETTING=VALUE` as `--set` takes them; an effect's name means all its entries. Errors (usage):
/// unknown names (with the nearest), values that the setting does not allow.
Result<std::vector<PresetEdit>> parse_edits(const Preset& preset, const std::vector<Override>& wanted);
/// The same for `ENTRY.SETTING` that go back to their defaults.
Result<std::vector<PresetEdit>> parse_resets(const Preset& preset, const std::vector<std::string>& wanted);

/// A change as it was made in the text.
struct WrittenSetting {
  std::string name;    ///< as PresetEdit::name
  int line = 0;        ///< in the new text
  std::string before;  ///< source text of the value; empty: it was not written
  std::string after;   ///< the same; empty: it was removed
};

struct RefusedSetting {
  PresetEdit edit;
  Error reason;  ///< file and line of what stands in the way, with its expression; usage: a name or value is wrong
};

/// What edits make of a preset's text. `text` equals `before` when nothing is to be changed.
struct Rewrite {
  std::string before, text;
  std::vector<WrittenSetting> written;  ///< by line; wanted values that were there already are not among them
  std::vector<RefusedSetting> refused;
  std::vector<std::string> notes;  ///< what the writer should know: volumes that are blended over a written value
};

/// Pure text and scripts: no file is written. `options`: as the preset is loaded; its overrides and text are ignored.
/// `before` is the text of `file`, which other scripts and effects are found beside. Errors (script): the preset does
/// not load; the new text would not give the wanted settings, or would change others. Unknown entries, settings and
/// volumes, and values that are not allowed, are refused, each by itself.
Result<Rewrite> rewrite_preset(const std::filesystem::path& file, const std::string& before,
                               const std::vector<PresetEdit>& edits, const PresetOptions& options);

/// A preset's text that is not in its file yet: changes go into it, and then all of it into the file.
struct WorkingText {
  std::string text;
  std::string base;  ///< of the file that it was made from
};

/// Saves into one preset's file, and takes saves back. Not thread-safe; needs no device, and about a load of the preset
/// for each call of plan (twice).
class PresetWriter {
 public:
  PresetWriter(std::filesystem::path file, PresetOptions options);

  const std::filesystem::path& file() const { return file_; }
  /// Reads the file; writes nothing. Errors: as rewrite_preset; io (also: the file is no longer `working`'s base).
  Result<Rewrite> plan(const std::vector<PresetEdit>& edits, const std::optional<WorkingText>& working = {}) const;
  /// Replaces the file, whole or not at all; links are followed, mode bits kept. Does nothing when there is no change.
  /// Errors (io): the file is no longer what the plan was made from; it cannot be written. Usage: it lies in a pack.
  Result<void> save(const Rewrite& rewrite);
  /// Errors (usage): the file lies in a pack.
  Result<void> check_file() const;

  /// How many saves can be taken back, at most 100.
  std::size_t saves() const { return saves_.size(); }
  /// The text before the last save. Errors (io): nothing was saved; the file is no longer what was saved.
  Result<void> undo();

 private:
  struct Save {
    std::string before, after;
  };
  Result<void> expect(const std::string& text) const;
  Result<void> replace(const std::string& before, const std::string& after) const;

  std::filesystem::path file_;
  PresetOptions options_;
  std::vector<Save> saves_;
};

}  // namespace afterglow
