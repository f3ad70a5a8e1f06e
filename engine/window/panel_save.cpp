// SPDX-License-Identifier: MIT
#include "window/panel_save.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "script/explanation.h"

namespace afterglow {
namespace {

// As a word of a shell.
std::string in_quotes(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

// Does the preset itself say this, without the edit over it?
bool says(const Build& build, const SettingEdit& edit) {
  for (const auto& entry : build.explanation->entries) {
    const SettingHistory* setting = entry.name == edit.entry ? entry.find(edit.setting) : nullptr;
    if (!setting) continue;
    const SettingValue& value = setting->preset ? *setting->preset : setting->default_value;
    for (std::size_t i = 0; i < value.number.size(); ++i)
      if (static_cast<float>(value.number[i]) != static_cast<float>(edit.value.number[i])) return false;
    return value.choice == edit.value.choice;
  }
  return true;  // enabled, at, order: nothing of them is kept of before an override
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

void PanelSave::save(PanelPort& port) {
  if (busy()) return;
  dismiss();
  saving_ = port.edits().edits();
  if (std::erase_if(saving_, [](const SettingEdit& edit) { return edit.entry.empty(); }) > 0)
    notes_.push_back("Arguments are not part of the preset: they are given by " + argument_words(port.edits()));
  if (saving_.empty()) return tell("No setting was changed", false);
  std::vector<PresetEdit> edits;
  for (const auto& edit : saving_) edits.push_back({edit.entry, edit.setting, edit.value, ""});
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

bool PanelSave::poll(PanelPort& port) {
  forget_what_is_in_the_file(port);
  if (!busy() || running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
  Outcome outcome = running_.get();
  if (outcome.error) {
    tell(outcome.error->text(), true);
    return true;
  }
  refused_ = std::move(outcome.rewrite.refused);
  std::ranges::move(outcome.rewrite.notes, std::back_inserter(notes_));
  std::erase_if(saving_, [&](const SettingEdit& edit) {
    return std::any_of(refused_.begin(), refused_.end(), [&](const RefusedSetting& refused) {
      return refused.edit.entry == edit.entry && refused.edit.setting == edit.setting;
    });
  });
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
void PanelSave::forget_what_is_in_the_file(PanelPort& port) {
  if (settling_.empty() || busy()) return;
  const Build* build = port.build();
  if (!build) return;
  const bool all = std::all_of(settling_.begin(), settling_.end(), [&](const SettingEdit& edit) {
    // Edited again since: the edit stays, and there is nothing to wait for.
    return port.edits().value(edit.entry, edit.setting) != edit.value || says(*build, edit);
  });
  if (!all || port.status().building) return;
  std::vector<SettingEdit> left = port.edits().edits();
  std::erase_if(left, [&](const SettingEdit& edit) {
    return std::find(settling_.begin(), settling_.end(), edit) != settling_.end();
  });
  settling_.clear();
  port.edits_saved();
  for (const auto& edit : left) {
    port.set(edit.entry, edit.setting, edit.value);
    port.end_gesture();
  }
}

void PanelSave::undo(PanelPort& port) {
  if (!can_undo()) return tell("Nothing was saved that could be taken back", true);
  dismiss();
  if (const auto undone = writer_.undo(); !undone) return tell(undone.error().text(), true);
  settling_.clear();
  for (const auto& edit : written_.back())
    if (!port.edits().value(edit.entry, edit.setting)) {
      port.set(edit.entry, edit.setting, edit.value);
      port.end_gesture();
    }
  written_.pop_back();
  tell(fmt::format("{} is as it was before", writer_.file().filename().string()), false);
}

}  // namespace afterglow
