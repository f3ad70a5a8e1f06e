// SPDX-License-Identifier: MIT
#include "edit/write_back_check.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/text.h"
#include "script/schema.h"

namespace afterglow::script {
namespace {

template <class List>
Error unknown(const std::string& what, const std::string& name, const List& list) {
  std::vector<std::string> names;
  for (const auto& item : list) names.push_back(item.name);
  return {ErrorKind::usage, fmt::format("{} '{}'", what, name), "", 0, join(names), nearest_name(name, names)};
}

const EntryHistory* history_of(const Preset& preset, const std::string& entry) {
  const auto& entries = preset.explanation().entries;
  const auto found = std::ranges::find(entries, entry, &EntryHistory::name);
  return found == entries.end() ? nullptr : &*found;
}

std::optional<SettingValue> of_volume(const SettingHistory& history, const std::string& volume) {
  for (const auto& step : history.volumes)
    if (step.volume == volume) return step.value;
  return {};
}

SettingValue value_of_key(const StackEntry& entry, const SettingSchema& schema) {
  SettingValue value;
  value.type = schema.type;
  if (schema.name == "enabled") value.number[0] = entry.enabled ? 1 : 0;
  if (schema.name == "order") value.number[0] = entry.order;
  if (schema.name == "at") value.choice = entry.at;
  return value;
}

std::string shown(const std::optional<SettingValue>& value) { return value ? value->text() : "nothing"; }

// What edits want of a setting, the last one counting; null when none names it.
const PresetEdit* edit_of(const std::vector<PresetEdit>& edits, const std::string& entry, const std::string& setting,
                          const std::string& volume) {
  const PresetEdit* found = nullptr;
  for (const auto& edit : edits)
    if (edit.entry == entry && edit.setting == setting && edit.volume == volume) found = &edit;
  return found;
}

Error differs(const std::string& name, const std::string& before, const std::string& after) {
  return {ErrorKind::script, fmt::format("nothing was written: {} would become {} instead of {}", name, after, before)};
}

std::string shown_kind(const std::string& kind) { return kind.empty() ? "the default" : kind; }

Result<void> check_value(const std::string& name, const std::optional<SettingValue>& before,
                         const std::optional<SettingValue>& after) {
  const bool same = before.has_value() == after.has_value() && (!before || *before == *after);
  return same ? Result<void>() : differs(name, shown(before), shown(after));
}

Result<void> check_wanted(const PresetEdit& edit, const SettingValue& wanted,
                          const std::optional<SettingValue>& after) {
  if (after && is_same(wanted, *after)) return {};
  return differs(edit.name(), wanted.text(), shown(after));
}

Result<void> check_setting_of(const StackEntry& entry, const SettingHistory& before, const SettingHistory& after,
                              const std::vector<PresetEdit>& edits) {
  const std::string name = entry.name + "." + before.name;
  if (const auto* edit = edit_of(edits, entry.name, before.name, "")) {
    AFTERGLOW_CHECK(
        check_wanted(*edit, edit->value.value_or(before.default_value), after.preset.value_or(after.default_value)));
    if (after.preset && after.kind != "fixed") return differs(name, "fixed", shown_kind(after.kind));
  } else {
    if (before.kind != after.kind) return differs(name, shown_kind(before.kind), shown_kind(after.kind));
    AFTERGLOW_CHECK(check_value(name, before.preset, after.preset));
  }
  for (const auto& volume : after.volumes)
    if (!edit_of(edits, entry.name, before.name, volume.volume))
      AFTERGLOW_CHECK(check_value(volume.volume + ": " + name, of_volume(before, volume.volume), volume.value));
  for (const auto& volume : before.volumes)
    if (!edit_of(edits, entry.name, before.name, volume.volume))
      AFTERGLOW_CHECK(check_value(volume.volume + ": " + name, volume.value, of_volume(after, volume.volume)));
  for (const auto& edit : edits)
    if (!edit.volume.empty() && edit.entry == entry.name && edit.setting == before.name)
      AFTERGLOW_CHECK(edit.value ? check_wanted(edit, *edit.value, of_volume(after, edit.volume))
                                 : check_value(edit.name(), std::nullopt, of_volume(after, edit.volume)));
  return {};
}

Result<void> check_entry(const StackEntry& before, const StackEntry& after, const std::vector<PresetEdit>& edits) {
  if (before.effect != after.effect) return differs(before.name, before.effect, after.effect);
  if (before.required != after.required || before.can_lack != after.can_lack)
    return differs(before.name + ".required", "as it is", "another");
  const auto mask = [](const StackEntry& entry) { return entry.mask ? entry.mask->text() : "none"; };
  if (mask(before) != mask(after)) return differs(before.name + ".mask", mask(before), mask(after));
  for (const char* key : {"enabled", "order", "at"}) {
    const SettingSchema schema = entry_key_schema(key);
    const auto* edit = edit_of(edits, before.name, key, "");
    if (edit && !edit->value) continue;
    AFTERGLOW_CHECK(check_value(before.name + "." + key, edit ? *edit->value : value_of_key(before, schema),
                                value_of_key(after, schema)));
  }
  return {};
}

}  // namespace

bool is_same(const SettingValue& a, const SettingValue& b) {
  if (a.type != b.type || a.choice != b.choice) return false;
  for (std::size_t i = 0; i < a.number.size(); ++i) {
    const bool same = a.type == SettingType::integer
                          ? a.number[i] == b.number[i]
                          : static_cast<float>(a.number[i]) == static_cast<float>(b.number[i]);
    if (!same) return false;
  }
  return true;
}

Result<Said> said_of(const Preset& preset, const PresetEdit& edit) {
  const auto& entries = preset.entries();
  const auto entry = std::ranges::find(entries, edit.entry, &StackEntry::name);
  if (entry == entries.end()) return unknown("the stack has no entry", edit.entry, entries);
  const auto& volumes = preset.explanation().volumes;
  if (!edit.volume.empty() && std::ranges::find(volumes, edit.volume, &VolumeState::name) == volumes.end())
    return unknown("the stack has no volume", edit.volume, volumes);
  Said said;
  const EntryHistory* of_entry = history_of(preset, edit.entry);
  const SettingHistory* history = of_entry ? of_entry->find(edit.setting) : nullptr;
  if (history) {
    said.schema = *preset.setting_schema(*entry, edit.setting);
    said.moving = history->preset && history->kind != "fixed" && edit.volume.empty();
    said.value =
        edit.volume.empty() ? history->preset.value_or(history->default_value) : of_volume(*history, edit.volume);
    said.blended = edit.volume.empty() && !history->volumes.empty();
    return said;
  }
  if (edit.volume.empty() && (edit.setting == "enabled" || edit.setting == "order" || edit.setting == "at")) {
    said.schema = entry_key_schema(edit.setting);
    said.value = value_of_key(*entry, said.schema);
    said.schema.default_value = said.value.value();
    said.schema.default_value.type = said.schema.type;
    if (edit.setting == "enabled") said.schema.default_value.number[0] = 1;
    if (edit.setting == "order") said.schema.default_value.number[0] = preset.schema(entry->effect).order;
    if (edit.setting == "at") said.schema.default_value.choice = preset.schema(entry->effect).at;
    return said;
  }
  const auto names = preset.setting_names(*entry);
  if (edit.setting == "mask")
    return Error{ErrorKind::usage, fmt::format("{} is made by the script and is changed there", edit.name()), "", 0,
                 "the settings of its parts: ENTRY.mask.PART.SETTING"};
  const std::string mask = script::missing_mask(edit.setting, names);
  return Error{ErrorKind::usage,
               mask.empty() ? fmt::format("effect '{}' has no setting '{}'", entry->effect, edit.setting)
                            : fmt::format("entry '{}' has no mask '{}'", edit.entry, mask),
               "",
               0,
               join(names),
               nearest_name(edit.setting, names)};
}

Result<void> check_stack(const Preset& before, const Preset& after) {
  const auto volumes = [](const Preset& preset) {
    std::string out;
    for (const auto& volume : preset.explanation().volumes)
      out += fmt::format("{} {} {} {}; ", volume.name, volume.priority, volume.weight, volume.factor);
    return out;
  };
  if (before.name() != after.name()) return differs("the stack's name", before.name(), after.name());
  if (before.max_error() != after.max_error()) return differs("max_error", "as it is", "another");
  if (before.input_space() != after.input_space()) return differs("input_space", "as it is", "another");
  if (before.keeps_negative() != after.keeps_negative()) return differs("gamut", "as it is", "another");
  if (before.sees_associated() != after.sees_associated()) return differs("alpha", "as it is", "another");
  if (before.explanation().position != after.explanation().position) return differs("position", "as it is", "another");
  if (volumes(before) != volumes(after)) return differs("the volumes", volumes(before), volumes(after));
  return {};
}

Result<void> check_edits(const Preset& before, const Preset& after, const std::vector<PresetEdit>& edits) {
  AFTERGLOW_CHECK(check_stack(before, after));
  if (before.entries().size() != after.entries().size())
    return differs("the stack", std::to_string(before.entries().size()) + " entries",
                   std::to_string(after.entries().size()));
  for (const auto& entry : before.entries()) {
    const auto other = std::ranges::find(after.entries(), entry.name, &StackEntry::name);
    if (other == after.entries().end()) return differs(entry.name, "an entry", "nothing");
    AFTERGLOW_CHECK(check_entry(entry, *other, edits));
    const EntryHistory *was = history_of(before, entry.name), *is = history_of(after, entry.name);
    if (!was || !is) return differs(entry.name, "an entry", "nothing");
    for (const auto* list : {&was->settings, &was->composition})
      for (const auto& setting : *list) {
        const SettingHistory* now = is->find(setting.name);
        if (!now) return differs(entry.name + "." + setting.name, "a setting", "nothing");
        AFTERGLOW_CHECK(check_setting_of(entry, setting, *now, edits));
      }
  }
  return {};
}

}  // namespace afterglow::script
