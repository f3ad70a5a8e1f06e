// SPDX-License-Identifier: MIT
#include "window/panel_save.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/file.h"
#include "core/process.h"
#include "core/replace_file.h"
#include "script/explanation.h"

namespace afterglow {
namespace {

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
    const std::string value = edit.value.choice.empty() ? edit.value.text() : edit.value.choice;
    out += (out.empty() ? "--arg " : " --arg ") + shell_word(edit.setting + "=" + value);
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
  const auto working = stack_.working(port);
  bool arguments = false;
  for (const SettingEdit& edit : port.edits().edits()) {
    if (edit.entry.empty()) {
      arguments = true;
    } else if (!working && settles(edit)) {
      continue;  // the file says so
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
  saving_stack_ = port.edits().stack_text();
  if (stack_.conflict())
    return tell(fmt::format("{} was changed since its stack was changed here: Keep mine or Take the file's",
                            writer_.file().filename().string()),
                true);
  if (saving_.empty() && !working) {
    refused_ = held_back_;
    return tell(refused_.empty() ? "No setting was changed" : "Nothing was written: the file was changed too", false);
  }
  std::vector<PresetEdit> edits;
  for (const auto& change : saving_) edits.push_back({change.entry, change.setting, change.after, ""});
  running_ = std::async(std::launch::async, [this, edits, working] { return write(edits, working); });
}

PanelSave::Outcome PanelSave::write(const std::vector<PresetEdit>& edits, const std::optional<WorkingText>& working) {
  Outcome outcome;
  auto plan = writer_.plan(edits, working);
  if (!plan) {
    outcome.error = plan.error();
    return outcome;
  }
  outcome.rewrite = std::move(*plan);
  if (const auto saved = writer_.save(outcome.rewrite); !saved) outcome.error = saved.error();
  return outcome;
}

void PanelSave::save_as(PanelPort& port, const std::filesystem::path& to) {
  if (busy()) return;
  dismiss();
  std::vector<PresetEdit> edits;
  for (const SettingEdit& edit : port.edits().edits())
    if (!edit.entry.empty()) edits.push_back({edit.entry, edit.setting, edit.value, ""});
  const auto working = stack_.working(port);
  copied_ = {port.edits().edits(), port.edits().stack_text()};
  running_ = std::async(std::launch::async, [this, edits, working, to] { return write_copy(edits, working, to); });
}

/// The text as a save would make it, run where it will lie: what it names beside it may not be there.
PanelSave::Outcome PanelSave::write_copy(const std::vector<PresetEdit>& edits,
                                         const std::optional<WorkingText>& working,
                                         const std::filesystem::path& to) const {
  Outcome outcome;
  const auto made = [&]() -> Result<void> {
    std::string text = working ? working->text : "";
    if (!working) {
      AFTERGLOW_TRY(text, read_file(writer_.file()));
    }
    AFTERGLOW_TRY(outcome.rewrite, rewrite_preset(writer_.file(), text, edits, options_));
    if (!outcome.rewrite.refused.empty()) {
      Error error = outcome.rewrite.refused[0].reason;
      error.message = "nothing was written: " + error.message;
      return error;
    }
    if (auto there = rewrite_preset(to, outcome.rewrite.text, {}, options_); !there) return there.error();
    std::error_code none;
    return std::filesystem::exists(to, none) ? replace_file_atomically(to, outcome.rewrite.text)
                                             : write_file_atomically(to, outcome.rewrite.text);
  }();
  if (!made) outcome.error = made.error();
  outcome.copy = to;
  return outcome;
}

bool PanelSave::poll(PanelPort& port, EditBases& bases) {
  settle(port, bases);
  forget_refused(port.edits());
  if (!busy() || running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
  Outcome outcome = running_.get();
  if (outcome.error) {
    tell(outcome.error->text(), true);
  } else if (outcome.copy) {
    const bool newer = copied_ != Edited{port.edits().edits(), port.edits().stack_text()};
    const std::string file = outcome.copy->string();
    tell(newer ? fmt::format("saved as {}; what was changed since is not in it", file) : "saved as " + file, false);
    if (!newer) copy_ = outcome.copy;  // opening it forgets all edits
  } else {
    take_saved(port, bases, std::move(outcome.rewrite));
  }
  return true;
}

void PanelSave::take_saved(PanelPort& port, EditBases& bases, Rewrite rewrite) {
  refused_ = std::move(rewrite.refused);
  std::ranges::move(rewrite.notes, std::back_inserter(notes_));
  std::erase_if(saving_, [&](const BaseChange& change) {
    return std::any_of(refused_.begin(), refused_.end(), [&](const RefusedSetting& refused) {
      return refused.edit.entry == change.entry && refused.edit.setting == change.setting;
    });
  });
  for (BaseChange& change : saving_) change.before = switched_before(rewrite, change).value_or(change.before);
  std::ranges::move(held_back_, std::back_inserter(refused_));
  const bool stack = saving_stack_ != nullptr;
  if (rewrite.text != rewrite.before) {
    written_.push_back(stack ? std::vector<BaseChange>() : saving_);
    texts_.push_back({rewrite.before, rewrite.text, stack});
  }
  if (written_.size() > writer_.saves()) {
    written_.erase(written_.begin());
    texts_.erase(texts_.begin());
  }
  stack_.wrote(rewrite.before, rewrite.text);
  if (stack) {  // what is on screen is what the file says now, at once
    for (const BaseChange& change : saving_) bases.expect(change.entry, change.setting, change.after);
    port.rebase(saving_, {rewrite.before, rewrite.text, saving_stack_});
  } else {
    std::erase_if(settling_, [&](const BaseChange& change) {
      return std::ranges::any_of(saving_, [&](const BaseChange& later) {
        return later.entry == change.entry && later.setting == change.setting;
      });
    });
    settling_.insert(settling_.end(), saving_.begin(), saving_.end());
    generation_ = port.status().generation;
    port.rebase({});  // builds anew: what comes of that has read the file since
  }
  const std::size_t count = rewrite.written.size();
  const std::string settings = count == 1 ? "1 setting" : fmt::format("{} settings", count);
  const std::string what = !stack ? settings : count == 0 ? "the stack" : "the stack and " + settings;
  const bool nothing = count == 0 && !stack;
  std::string text = nothing && saving_.empty() ? "Nothing was written"
                     : nothing                  ? "The preset says so already"
                               : fmt::format("{} written to {}", what, writer_.file().filename().string());
  if (!refused_.empty()) text = fmt::format("{}; {} left out", text, refused_.size());
  tell(std::move(text), false);
}

/// What was left out and has been taken back since is no news any more.
void PanelSave::forget_refused(const SettingEdits& edits) {
  if (busy() || refused_.empty()) return;
  std::erase_if(refused_,
                [&](const RefusedSetting& refused) { return !edits.value(refused.edit.entry, refused.edit.setting); });
  if (refused_.empty()) dismiss();
}

bool PanelSave::settles(const SettingEdit& edit) const {
  return std::ranges::any_of(settling_, [&](const BaseChange& change) {
    return change.entry == edit.entry && change.setting == edit.setting && change.after == edit.value;
  });
}

// The edits go when the preset on screen says the same: dropping them before would show the old values for a moment.
// What the first build since says otherwise, another program has changed: its edit stays, and is in conflict.
void PanelSave::settle(PanelPort& port, EditBases& bases) {
  if (settling_.empty() || busy()) return;
  const Build* build = port.build();
  const LiveStatus status = port.status();
  if (!build || status.building) return;
  const auto is_said = [&](const BaseChange& change) { return says(*build, change); };
  const bool is_later = status.generation > generation_ && !status.error;
  if (!is_later && !std::ranges::all_of(settling_, is_said)) return;
  std::vector<BaseChange> changes = std::exchange(settling_, {});
  for (const BaseChange& change : changes) bases.expect(change.entry, change.setting, change.after);
  std::erase_if(changes, [&](const BaseChange& change) { return !is_said(change); });
  port.rebase(changes);
}

void PanelSave::undo(PanelPort& port, EditBases& bases) {
  if (!can_undo()) return tell("Nothing was saved that could be taken back", true);
  dismiss();
  if (const auto undone = writer_.undo(); !undone) return tell(undone.error().text(), true);
  std::vector<BaseChange> back = std::move(written_.back());
  const SavedText text = std::move(texts_.back());
  written_.pop_back();
  texts_.pop_back();
  stack_.wrote(text.after, text.before);
  if (text.stack) {
    settling_.clear();
    port.rebase({}, {text.after, text.before, nullptr});
    return tell(fmt::format("{} is as it was before", writer_.file().filename().string()), false);
  }
  for (BaseChange& change : back) {
    bases.expect(change.entry, change.setting, change.before);
    std::swap(change.before, change.after);
  }
  // What was still settling has not become part of the preset: its edits are there.
  if (std::exchange(settling_, {}).empty()) port.rebase(back);
  tell(fmt::format("{} is as it was before", writer_.file().filename().string()), false);
}

}  // namespace afterglow
