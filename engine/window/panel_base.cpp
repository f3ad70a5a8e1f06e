// SPDX-License-Identifier: MIT
#include "window/panel_base.h"

#include <algorithm>

#include "script/explanation.h"

namespace afterglow {

namespace {

const SettingHistory* history_of(const Build& build, const std::string& entry, const std::string& setting) {
  for (const auto& history : build.explanation->entries) {
    const SettingHistory* found = history.name == entry ? history.find(setting) : nullptr;
    if (found) return found;
  }
  return nullptr;
}

/// A curve or a function says another value with each frame, though nothing was changed.
bool moves(const SettingHistory& history) { return history.preset && history.kind != "fixed"; }

}  // namespace

std::optional<SettingValue> base_value(const Build& build, const std::string& entry, const std::string& setting) {
  const SettingHistory* history = history_of(build, entry, setting);
  return history ? std::optional(history->preset.value_or(history->default_value)) : std::nullopt;
}

bool same_value(const SettingValue& a, const SettingValue& b) {
  for (std::size_t i = 0; i < a.number.size(); ++i)
    if (static_cast<float>(a.number[i]) != static_cast<float>(b.number[i])) return false;
  return a.choice == b.choice;
}

EditBases::Base* EditBases::base_of(const std::string& entry, const std::string& setting) {
  const auto found =
      std::ranges::find_if(bases_, [&](const Base& base) { return base.entry == entry && base.setting == setting; });
  return found == bases_.end() ? nullptr : &*found;
}

void EditBases::follow(PanelPort& port) {
  conflicts_.clear();
  const Build* build = port.build();
  if (!build) return;
  const SettingEdits& edits = port.edits();
  std::erase_if(bases_, [&](const Base& base) { return !edits.value(base.entry, base.setting); });
  for (const SettingEdit& edit : edits.edits()) {
    const SettingHistory* history = history_of(*build, edit.entry, edit.setting);
    if (!history || moves(*history)) continue;
    const auto now = base_value(*build, edit.entry, edit.setting);
    Base* base = base_of(edit.entry, edit.setting);
    if (!base) {
      bases_.push_back({edit.entry, edit.setting, *now});
    } else if (same_value(edit.value, *now)) {
      base->value = *now;
    } else if (!same_value(base->value, *now)) {
      conflicts_.push_back({edit.entry, edit.setting, base->value, *now});
    }
  }
}

const EditConflict* EditBases::find(const std::string& entry, const std::string& setting) const {
  const auto found = std::ranges::find_if(
      conflicts_, [&](const EditConflict& conflict) { return conflict.entry == entry && conflict.setting == setting; });
  return found == conflicts_.end() ? nullptr : &*found;
}

void EditBases::keep(const std::string& entry, const std::string& setting) {
  if (const EditConflict* conflict = find(entry, setting)) expect(entry, setting, SettingValue(conflict->now));
}

void EditBases::expect(const std::string& entry, const std::string& setting, const SettingValue& value) {
  if (Base* base = base_of(entry, setting)) {
    base->value = value;
  } else {
    bases_.push_back({entry, setting, value});
  }
  std::erase_if(conflicts_,
                [&](const EditConflict& conflict) { return conflict.entry == entry && conflict.setting == setting; });
}

}  // namespace afterglow
