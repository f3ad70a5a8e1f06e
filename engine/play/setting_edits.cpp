// SPDX-License-Identifier: MIT
#include "play/setting_edits.h"

#include <algorithm>

namespace afterglow {
namespace {

constexpr std::size_t kMostSteps = 1000;

auto is(const std::string& entry, const std::string& setting) {
  return [&](const SettingEdit& edit) { return edit.entry == entry && edit.setting == setting; };
}

}  // namespace

bool SettingEdits::take(Step step, const std::string& gesture) {
  if (step == history_[at_]) return false;
  const bool same_step = !gesture.empty() && gesture == open_ && at_ > 0 && at_ + 1 == history_.size();
  history_.resize(at_ + 1);
  if (same_step) {
    history_[at_] = std::move(step);
  } else {
    history_.push_back(std::move(step));
    if (history_.size() > kMostSteps) history_.erase(history_.begin());
    at_ = history_.size() - 1;
  }
  open_ = gesture;
  return true;
}

void SettingEdits::set(std::vector<SettingEdit>& edits, const SettingEdit& value) {
  const auto found = std::ranges::find_if(edits, is(value.entry, value.setting));
  if (found != edits.end()) {
    found->value = value.value;
  } else {
    edits.push_back(value);
  }
}

void SettingEdits::set(const std::string& entry, const std::string& setting, const SettingValue& value) {
  Step step = history_[at_];
  set(step.edits, {entry, setting, value});
  take(std::move(step), entry + "." + setting);
}

void SettingEdits::set_all(const std::vector<SettingEdit>& values) {
  Step step = history_[at_];
  for (const SettingEdit& value : values) set(step.edits, value);
  take(std::move(step), "");
}

void SettingEdits::set_stack(const StackChange& change) {
  Step step{{}, change.text};
  for (const SettingEdit& edit : edits()) {
    const auto now = std::ranges::find(change.renamed, edit.entry, &std::pair<std::string, std::string>::first);
    if (edit.entry.empty()) step.edits.push_back(edit);
    if (now == change.renamed.end()) continue;
    step.edits.push_back({now->second, edit.setting, edit.value});
    if (now->second == change.copied) step.edits.push_back({change.copy, edit.setting, edit.value});
  }
  take(std::move(step), "");
}

bool SettingEdits::reset_stack() { return take({edits(), nullptr}, ""); }

bool SettingEdits::reset(const std::string& entry, const std::string& setting) {
  Step step = history_[at_];
  std::erase_if(step.edits, is(entry, setting));
  return take(std::move(step), "");
}

bool SettingEdits::reset_all() { return take({}, ""); }

bool SettingEdits::recall(int snapshot) {
  const auto& kept = snapshots_[static_cast<std::size_t>(snapshot)];
  return kept && take(*kept, "");
}

template <class Change>
void SettingEdits::for_all_steps(Change&& change) {
  for (Step& step : history_) change(step);
  for (auto& snapshot : snapshots_)
    if (snapshot) change(*snapshot);
}

bool SettingEdits::undo() {
  if (!can_undo()) return false;
  --at_;
  open_.clear();
  return true;
}

bool SettingEdits::redo() {
  if (!can_redo()) return false;
  ++at_;
  open_.clear();
  return true;
}

bool SettingEdits::take_back() {
  if (!undo()) return false;
  history_.resize(at_ + 1);
  return true;
}

void SettingEdits::rebase(std::vector<SettingEdit>& edits, const std::vector<BaseChange>& changes) {
  for (const BaseChange& change : changes) {
    const auto found = std::ranges::find_if(edits, is(change.entry, change.setting));
    if (found == edits.end()) {
      if (!(change.before == change.after)) edits.push_back({change.entry, change.setting, change.before});
    } else if (found->value == change.after) {
      edits.erase(found);
    }
  }
}

void SettingEdits::rebase(const std::vector<BaseChange>& changes) {
  open_.clear();
  for_all_steps([&](Step& step) {
    if (!step.text) rebase(step.edits, changes);
  });
}

void SettingEdits::rebase(const std::vector<BaseChange>& changes, const TextChange& text) {
  open_.clear();
  const auto before = std::make_shared<const std::string>(text.before);
  for_all_steps([&](Step& step) {
    if (!step.text) {
      step.text = before;
    } else if (step.text == text.written) {
      rebase(step.edits, changes);
      step.text = nullptr;
    } else if (*step.text == text.after) {
      step.text = nullptr;
    }
  });
}

std::optional<SettingValue> SettingEdits::value(const std::string& entry, const std::string& setting) const {
  const auto found = std::ranges::find_if(edits(), is(entry, setting));
  return found == edits().end() ? std::nullopt : std::optional(found->value);
}

std::vector<Override> SettingEdits::overrides(const std::vector<Override>& given) const {
  std::vector<Override> all = given;
  for (const SettingEdit& edit : edits())
    if (!edit.entry.empty()) all.push_back({edit.entry, edit.setting, edit.value.text()});
  return all;
}

std::vector<ArgumentValue> SettingEdits::arguments(const std::vector<ArgumentValue>& given) const {
  std::vector<ArgumentValue> all = given;
  for (const SettingEdit& edit : edits())
    if (edit.entry.empty()) all.push_back({edit.setting, edit.value.text()});
  return all;
}

}  // namespace afterglow
