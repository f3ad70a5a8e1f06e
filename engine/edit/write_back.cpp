// SPDX-License-Identifier: MIT
#include "edit/write_back.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/file.h"
#include "core/key_finder.h"
#include "core/printable.h"
#include "edit/write_back_check.h"
#include "edit/write_back_place.h"
#include "script/schema.h"

namespace afterglow {

Result<Preset> script::load_text(const std::filesystem::path& file, std::string text, PresetOptions options) {
  options.overrides.clear();
  options.text = std::move(text);
  ShaderLibrary shaders(search_path_for(file, options.paths));
  Diagnostics silent;
  return Preset::load(file, options, shaders, silent);
}

using namespace script;

namespace {

/// An edit with all that is known about it before the text is touched.
struct Task {
  PresetEdit edit;
  Said said;
  Place place;
  SettingValue wanted;  ///< the default, when it goes back to that
};

/// How the place of each edit is found. `first`: the first that can be written to, all are checked together; `tried`:
/// each place by loading the preset with that edit alone. Where none can be written to, both say the same.
enum class Places { first, tried };

class Rewriter {
 public:
  Rewriter(std::string file, const std::string& text, const PresetOptions& options, const Preset& preset, Places places)
      : file_(std::move(file)), options_(options), preset_(preset), places_(places), lua_(text) {
    out_.before = out_.text = text;
  }

  Result<Rewrite> run(const std::vector<PresetEdit>& edits) {
    for (auto edit = edits.begin(); edit != edits.end(); ++edit) {
      const bool again =
          std::any_of(edit + 1, edits.end(), [&](const PresetEdit& later) { return later.name() == edit->name(); });
      if (again) continue;
      if (auto reason = prepare(*edit)) out_.refused.push_back({*edit, std::move(*reason)});
    }
    // From the end of the text to its beginning, so that places stay where they were found.
    std::stable_sort(tasks_.begin(), tasks_.end(),
                     [](const Task& a, const Task& b) { return a.place.offset > b.place.offset; });
    for (const Task& task : tasks_) {
      AFTERGLOW_TRY(const Change change, change_of(LuaText(out_.text), task));
      apply(task, change);
    }
    AFTERGLOW_CHECK(check());
    finish();
    return std::move(out_);
  }

 private:
  struct Written {
    WrittenSetting setting;
    std::size_t at;
  };

  Result<Change> change_of(const LuaText& text, const Task& task) const {
    return task.edit.value ? write_at(text, file_, task.place, task.edit, task.wanted)
                           : remove_at(text, file_, task.place, task.edit, task.wanted);
  }

  // Adds the task of an edit, if it is one; the reason why it cannot be made.
  std::optional<Error> prepare(const PresetEdit& edit) {
    Task task{edit, {}, {}, {}};
    auto said = said_of(preset_, edit);
    if (!said) return said.error();
    task.said = std::move(*said);
    task.wanted = edit.value.value_or(task.said.schema.default_value);
    if (task.wanted.type != task.said.schema.type)
      return Error{ErrorKind::usage, fmt::format("{} is of another type", edit.name()), "", 0,
                   allowed_text(task.said.schema)};
    if (const auto checked = check_value(edit.name(), task.said.schema, task.wanted); !checked) return checked.error();
    const bool removes = !edit.value && !edit.volume.empty();
    const bool is_there = removes ? !task.said.value : task.said.value && is_same(*task.said.value, task.wanted);
    if (is_there && !task.said.moving && edit.value) return {};
    if (auto reason = choose_place(task)) return reason;
    if (task.said.blended)
      out_.notes.push_back(fmt::format("{}: volumes are blended over it; see `afterglow explain`", edit.name()));
    tasks_.push_back(std::move(task));
    return {};
  }

  // The first place that does what the edit wants and nothing else; the reason when there is none.
  std::optional<Error> choose_place(Task& task) const {
    const auto places = places_of(lua_, preset_, file_, task.edit);
    if (!places) return places.error();
    std::optional<Error> reason;
    bool expression = false;
    for (const Place& place : *places) {
      task.place = place;
      if (places_ == Places::first && takes(task)) return {};
      auto failure = try_place(task, places->size() == 1);
      if (!failure) return {};
      // An expression says most; else the first place, which fits best.
      const bool is_expression = !change_of(lua_, task);
      if (!reason || (is_expression && !expression)) reason = std::move(failure);
      expression = expression || is_expression;
    }
    return reason;
  }

  bool takes(const Task& task) const {
    const auto change = change_of(lua_, task);
    return change && !(task.said.moving && change->before.empty());
  }

  // `alone`: no other place is left to choose.
  std::optional<Error> try_place(Task& task, bool alone) const {
    const auto change = change_of(lua_, task);
    if (!change) return change.error();
    if (task.said.moving && change->before.empty()) return moving_elsewhere(task);
    const auto failure = probe(task.edit, *change, alone);
    if (!failure || task.edit.value) return failure;
    // Without the key it is not the default: another preset, or a second key, says something.
    PresetEdit fixed = task.edit;
    fixed.value = task.wanted;
    if (!fixed.volume.empty()) return failure;
    const auto instead = write_at(lua_, file_, task.place, fixed, task.wanted);
    if (!instead) return instead.error();
    if (auto still = probe(fixed, *instead, alone)) return still;
    task.edit.value = task.wanted;
    return {};
  }

  // Values may be allowed only together with those of other edits: what does not load is left to the check of all,
  // where there is no choice.
  std::optional<Error> probe(const PresetEdit& edit, const Change& change, bool alone) const {
    if (change.replacements.empty()) return {};
    const auto after = load_text(file_, replaced(out_.before, change.replacements), options_);
    Error error{ErrorKind::script, ""};
    if (!after) {
      if (alone) return {};
      error = after.error();
    } else {
      const auto checked = check_edits(preset_, *after, {edit});
      if (checked) return {};
      error = checked.error();
    }
    return as_reason(edit, error);
  }

  // Why the text cannot be changed there: with the line of the entry.
  Error as_reason(const PresetEdit& edit, const Error& error) const {
    const auto& entries = preset_.entries();
    const auto entry = std::ranges::find(entries, edit.entry, &StackEntry::name);
    const auto shared = std::ranges::count_if(
        entries, [&](const StackEntry& other) { return other.file == entry->file && other.line == entry->line; });
    if (edit.volume.empty() && shared > 1 && entry->file == file_)
      return {ErrorKind::script,
              fmt::format("{} cannot be changed alone: {} entries are made on this line", edit.name(), shared),
              entry->file,
              entry->line,
              "",
              "",
              {error.message}};
    Error reason = error;
    if (reason.file.empty()) {
      reason.file = entry->file;
      reason.line = entry->line;
    }
    return reason;
  }

  // A curve or function that does not stand in the table: of a preset that this one extends, or a second key.
  Error moving_elsewhere(const Task& task) const {
    const auto entry = std::ranges::find(preset_.entries(), task.edit.entry, &StackEntry::name);
    Error error{ErrorKind::script, fmt::format("{} is a curve or a function and stays as it is", task.edit.name()),
                entry->file, entry->line};
    if (const auto text = read_script(entry->file))
      error.line = line_of_key(*text, entry->line, entry->effect, {task.edit.setting});
    return error;
  }

  std::optional<std::string> read_script(const std::string& file) const {
    if (file == file_) return out_.before;
    auto text = read_file(file);
    return text ? std::optional(std::move(*text)) : std::nullopt;
  }

  void apply(const Task& task, const Change& change) {
    if (change.replacements.empty()) return;
    for (Written& other : written_)
      for (const auto& part : change.replacements)
        if (other.at >= part.offset + part.length) other.at += part.text.size() - part.length;
    out_.text = replaced(out_.text, change.replacements);
    written_.push_back({{task.edit.name(), 0, change.before, change.after}, change.at});
    made_.push_back(task.edit);
  }

  // All edits together: what none of them may do alone, and values that are allowed together alone.
  Result<void> check() const {
    if (made_.empty()) return {};
    const auto after = load_text(file_, out_.text, options_);
    if (!after) {
      Error error = after.error();
      error.message = "nothing was written: the preset would not load: " + error.message;
      return error;
    }
    auto checked = check_edits(preset_, *after, made_);
    if (checked) return {};
    Error error = checked.error();
    error.file = file_;
    return error;
  }

  void finish() {
    std::sort(written_.begin(), written_.end(), [](const Written& a, const Written& b) { return a.at < b.at; });
    for (Written& one : written_) {
      one.setting.line = line_at(out_.text, one.at);
      out_.written.push_back(std::move(one.setting));
    }
  }

  static int line_at(const std::string& text, std::size_t offset) {
    int line = 1;
    for (std::size_t i = 0; i < std::min(offset, text.size()); ++i)
      line += text[i] == '\n' || (text[i] == '\r' && (i + 1 == text.size() || text[i + 1] != '\n'));
    return line;
  }

  std::string file_;
  const PresetOptions& options_;
  const Preset& preset_;
  Places places_;
  LuaText lua_;
  Rewrite out_;
  std::vector<Task> tasks_;
  std::vector<Written> written_;
  std::vector<PresetEdit> made_;
};

// Entries that a name means, as `--set` reads it.
std::vector<std::string> entries_called(const Preset& preset, const std::string& name) {
  std::vector<std::string> by_effect;
  for (const auto& entry : preset.entries()) {
    if (entry.name == name) return {name};
    if (entry.effect == name) by_effect.push_back(entry.name);
  }
  return by_effect.empty() ? std::vector{name} : by_effect;
}

}  // namespace

std::string PresetEdit::name() const {
  return fmt::format("{}{}{}.{}", volume, volume.empty() ? "" : ": ", entry, setting);
}

Result<std::vector<PresetEdit>> parse_edits(const Preset& preset, const std::vector<Override>& wanted) {
  std::vector<PresetEdit> edits;
  for (const auto& given : wanted)
    for (const auto& entry : entries_called(preset, given.entry)) {
      PresetEdit edit{entry, given.setting, {}, ""};
      AFTERGLOW_TRY(const Said said, said_of(preset, edit));
      AFTERGLOW_TRY(edit.value, parse_setting(given, said.schema, ""));
      edits.push_back(std::move(edit));
    }
  return edits;
}

Result<std::vector<PresetEdit>> parse_resets(const Preset& preset, const std::vector<std::string>& wanted) {
  std::vector<PresetEdit> edits;
  for (const auto& name : wanted) {
    const std::size_t dot = name.find('.');
    if (dot == std::string::npos || dot == 0 || dot + 1 == name.size())
      return Error{ErrorKind::usage, fmt::format("'{}' is no setting", tidy_message(name, 100)), "", 0,
                   "ENTRY.SETTING"};
    for (const auto& entry : entries_called(preset, name.substr(0, dot))) {
      edits.push_back({entry, name.substr(dot + 1), {}, ""});
      AFTERGLOW_TRY([[maybe_unused]] const Said said, said_of(preset, edits.back()));
    }
  }
  return edits;
}

Result<Rewrite> rewrite_preset(const std::filesystem::path& file, const std::string& before,
                               const std::vector<PresetEdit>& edits, const PresetOptions& options) {
  AFTERGLOW_TRY(const Preset preset, load_text(file, before, options));
  if (edits.size() > 1) {  // in one load of the preset, where that does what all of them want
    auto rewrite = Rewriter(file.string(), before, options, preset, Places::first).run(edits);
    if (rewrite) return rewrite;
  }
  return Rewriter(file.string(), before, options, preset, Places::tried).run(edits);
}

}  // namespace afterglow
