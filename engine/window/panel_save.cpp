// SPDX-License-Identifier: MIT
#include "window/panel_save.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "script/explanation.h"

namespace afterglow {
namespace {

// As a word of a shell.
std::string in_quotes(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

// Does the preset itself say this, without the edit over it? Of what nobody knows, yes.
bool says(const Build& build, const BaseChange& change) {
  const auto value = base_value(build, change.entry, change.setting);
  return !value || same_value(*value, change.after);
}

// The value of an entry's own switch before the save, by the text that stood there.
std::optional<SettingValue> switched_before(const Rewrite& rewrite, const BaseChange& change) {
  const std::string name = PresetEdit{change.entry, change.setting}.name();
  const auto found = std::ranges::find_if(rewrite.written, [&](const WrittenSetting& w) { return w.name == name; });
  if (change.setting != "enabled" || found == rewrite.written.end()) return std::nullopt;
  return SettingValue{SettingType::boolean, {found->before == "false" ? 0.0 : 1.0}, ""};
}

Error conflict_error(const std::filesystem::path& file, const EditConflict& conflict, const SettingEdit& edit) {
  Error error{ErrorKind::script,
              fmt::format("{}.{} was changed in the file too: it says {} now, the panel {}", edit.entry, edit.setting,
                          conflict.now.text(), edit.value.text()),
              file.string()};
  error.allowed = "Keep mine or Take the file's, below the setting";
  return error;
}

}  // namespace

std::string argument_words(const SettingEdits& edits) {
  std::string out;
  for (const auto& edit : edits.edits()) {
    if (!edit.entry.empty()) continue;
    const bool plain = edit.value.choice.empty() && edit.value.type != SettingType::vec2 &&
                       edit.value.type != SettingType::vec3 && edit.value.type != SettingType::color;
    const std::string value = edit.value.choice.empty() ? edit.value.text() : edit.value.choice;
    const std::string word = edit.setting + "=" + value;
    out += (out.empty() ? "--arg " : " --arg ") + (plain ? word : in_quotes(word));
  }
  return out;
}

void PanelSave::tell(std::string message, bool failed) {
  message_ = std::move(message);
  failed_ = failed;
}

void PanelSave::dismiss() {
  tell("", false);
  refused_.clear();
  notes_.clear();
}

void PanelSave::save(PanelPort& port, const EditBases& bases) {
  if (busy()) return;
  dismiss();
  saving_.clear();
  held_back_.clear();
  const Build* build = port.build();
  bool arguments = false;
  for (const SettingEdit& edit : port.edits().edits()) {
    if (edit.entry.empty()) {
      arguments = true;
    } else if (const EditConflict* conflict = bases.find(edit.entry, edit.setting)) {
      held_back_.push_back(
          {{edit.entry, edit.setting, edit.value, ""}, conflict_error(writer_.file(), *conflict, edit)});
    } else {
      const auto before = build ? base_value(*build, edit.entry, edit.setting) : std::nullopt;
      saving_.push_back({edit.entry, edit.setting, before.value_or(edit.value), edit.value});
    }
  }
  if (arguments)
    notes_.push_back("Arguments are not part of the preset: they are given by " + argument_words(port.edits()));
  if (saving_.empty()) {
    refused_ = held_back_;
    return tell(refused_.empty() ? "No setting was changed" : "Nothing was written: the file was changed too", false);
  }
  std::vector<PresetEdit> edits;
  for (const auto& change : saving_) edits.push_back({change.entry, change.setting, change.after, ""});
  running_ = std::async(std::launch::async, [this, edits] {
    Outcome outcome;
    auto plan = writer_.plan(edits);
    if (!plan) {
      outcome.error = plan.error();
      return outcome;
    }
    outcome.rewrite = std::move(*plan);
    if (const auto saved = writer_.save(outcome.rewrite); !saved) outcome.error = saved.error();
    return outcome;
  });
}

bool PanelSave::poll(PanelPort& port, EditBases& bases) {
  forget_what_is_in_the_file(port, bases);
  if (!busy() || running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
  Outcome outcome = running_.get();
  if (outcome.error) {
    tell(outcome.error->text(), true);
    return true;
  }
  refused_ = std::move(outcome.rewrite.refused);
  std::ranges::move(outcome.rewrite.notes, std::back_inserter(notes_));
  std::erase_if(saving_, [&](const BaseChange& change) {
    return std::any_of(refused_.begin(), refused_.end(), [&](const RefusedSetting& refused) {
      return refused.edit.entry == change.entry && refused.edit.setting == change.setting;
    });
  });
  for (BaseChange& change : saving_) change.before = switched_before(outcome.rewrite, change).value_or(change.before);
  std::ranges::move(held_back_, std::back_inserter(refused_));
  settling_ = saving_;
  if (outcome.rewrite.text != outcome.rewrite.before) written_.push_back(saving_);
  if (written_.size() > writer_.saves()) written_.erase(written_.begin());
  std::string text = outcome.rewrite.written.empty()
                         ? "The preset says so already"
                         : fmt::format("{} written to {}",
                                       outcome.rewrite.written.size() == 1
                                           ? std::string("1 setting")
                                           : fmt::format("{} settings", outcome.rewrite.written.size()),
                                       writer_.file().filename().string());
  if (!refused_.empty()) text = fmt::format("{}; {} left out", text, refused_.size());
  tell(std::move(text), false);
  return true;
}

// The edits go when the preset on screen says the same: dropping them before would show the old values for a moment.
void PanelSave::forget_what_is_in_the_file(PanelPort& port, EditBases& bases) {
  if (settling_.empty() || busy()) return;
  const Build* build = port.build();
  if (!build || port.status().building) return;
  const bool all = std::all_of(settling_.begin(), settling_.end(), [&](const BaseChange& change) {
    // Edited again since: the edit stays, and there is nothing to wait for.
    return port.edits().value(change.entry, change.setting) != change.after || says(*build, change);
  });
  if (!all) return;
  for (const BaseChange& change : settling_) bases.expect(change.entry, change.setting, change.after);
  port.rebase(std::exchange(settling_, {}));
}

void PanelSave::undo(PanelPort& port, EditBases& bases) {
  if (!can_undo()) return tell("Nothing was saved that could be taken back", true);
  dismiss();
  if (const auto undone = writer_.undo(); !undone) return tell(undone.error().text(), true);
  std::vector<BaseChange> back = std::move(written_.back());
  written_.pop_back();
  for (BaseChange& change : back) {
    bases.expect(change.entry, change.setting, change.before);
    std::swap(change.before, change.after);
  }
  // What was still settling has not become part of the preset: its edits are there.
  if (std::exchange(settling_, {}).empty()) port.rebase(back);
  tell(fmt::format("{} is as it was before", writer_.file().filename().string()), false);
}

}  // namespace afterglow
