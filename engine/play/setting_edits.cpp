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

bool SettingEdits::take(std::vector<SettingEdit> edits, const std::string& gesture) {
  if (edits == history_[at_]) return false;
  const bool same_step = !gesture.empty() && gesture == open_ && at_ > 0 && at_ + 1 == history_.size();
  history_.resize(at_ + 1);
  if (same_step) {
    history_[at_] = std::move(edits);
  } else {
    history_.push_back(std::move(edits));
    if (history_.size() > kMostSteps) history_.erase(history_.begin());
    at_ = history_.size() - 1;
  }
  open_ = gesture;
  return true;
}

void SettingEdits::set(const std::string& entry, const std::string& setting, const SettingValue& value) {
  auto edits = history_[at_];
  const auto found = std::ranges::find_if(edits, is(entry, setting));
  if (found != edits.end()) {
    found->value = value;
  } else {
    edits.push_back({entry, setting, value});
  }
  take(std::move(edits), entry + "." + setting);
}

bool SettingEdits::reset(const std::string& entry, const std::string& setting) {
  auto edits = history_[at_];
  std::erase_if(edits, is(entry, setting));
  return take(std::move(edits), "");
}

bool SettingEdits::reset_entry(const std::string& entry) {
  auto edits = history_[at_];
  std::erase_if(edits, [&](const SettingEdit& edit) { return edit.entry == entry; });
  return take(std::move(edits), "");
}

bool SettingEdits::reset_all() { return take({}, ""); }

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

void SettingEdits::rebase(const std::vector<BaseChange>& changes) {
  open_.clear();
  for (auto& step : history_)
    for (const BaseChange& change : changes) {
      const auto found = std::ranges::find_if(step, is(change.entry, change.setting));
      if (found == step.end()) {
        if (!(change.before == change.after)) step.push_back({change.entry, change.setting, change.before});
      } else if (found->value == change.after) {
        step.erase(found);
      }
    }
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
