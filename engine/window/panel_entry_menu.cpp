// SPDX-License-Identifier: MIT
// What can be done to an entry as a whole: by its menu, and by keys for the one that is chosen.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "script/build.h"
#include "script/explanation.h"
#include "window/panel.h"
#include "window/shortcuts.h"

namespace afterglow {
namespace {

using Kind = StackEdit::Kind;

bool in_file(const StackEntry& entry, const std::filesystem::path& file) { return entry.file == file.string(); }

/// The entry that is chosen when one is removed with its members: that behind it, or else before it; empty: none is
/// left.
std::string neighbour_of(PanelPort& port, const std::string& name) {
  const Build* build = port.build();
  if (!build) return {};
  const auto& entries = *build->entries;
  const auto at = std::ranges::find(entries, name, &StackEntry::name);
  if (at == entries.end()) return {};
  const auto index = static_cast<std::size_t>(at - entries.begin()), end = at->end_of(index);
  return end < entries.size() ? entries[end].name : index > 0 ? entries[index - 1].name : "";
}

}  // namespace

const StackEntry* Panel::entry_named(PanelPort& port, const std::string& name) const {
  const Build* build = port.build();
  if (!build) return nullptr;
  const auto found = std::ranges::find(*build->entries, name, &StackEntry::name);
  return found == build->entries->end() ? nullptr : &*found;
}

void Panel::act(Ui& ui, PanelPort& port, EntryAction action) {
  if (chosen_.empty()) return ui.say("No effect is chosen: click its name, or PageDown");
  if (port.status().error) return ui.say("The preset has an error: the stack rests until it is mended");
  switch (action) {
    case EntryAction::remove:
      stack_.begin({Kind::remove, chosen_});
      removed_ = std::exchange(chosen_, neighbour_of(port, chosen_));
      return;
    case EntryAction::duplicate:
      return stack_.begin({Kind::duplicate, chosen_});
    case EntryAction::earlier:
      return stack_.begin({Kind::earlier, chosen_});
    case EntryAction::later:
      return stack_.begin({Kind::later, chosen_});
    default:
      break;
  }
  const StackEntry* entry = entry_named(port, chosen_);
  if (!entry) {
    if (!act_due_) act_due_ = {action, chosen_, ui.now};
    return ui.again();
  }
  if (action == EntryAction::copy) return copy_settings(ui, port, *entry);
  if (action == EntryAction::paste) return paste_settings(ui, port, *entry);
  const auto edited = port.edits().value(chosen_, "enabled");
  const bool on = edited ? edited->number[0] != 0 : entry->enabled;
  port.end_gesture();
  port.set(chosen_, "enabled", {SettingType::boolean, {on ? 0.0 : 1.0}, ""});
  port.end_gesture();
  ui.say(chosen_ + (on ? " is off" : " is on"));
}

/// What is done to an entry that was just made waits until it is built.
void Panel::act_when_built(Ui& ui, PanelPort& port) {
  constexpr double kPatience = 3;  // seconds without a build
  if (!act_due_) return;
  if (act_due_->entry != chosen_) return act_due_.reset();
  if (stack_.busy() || port.status().building) act_due_->since = ui.now;
  if (entry_named(port, chosen_)) return act(ui, port, std::exchange(act_due_, std::nullopt)->action);
  if (ui.now - act_due_->since < kPatience) return ui.again();
  ui.say("the stack has no entry " + chosen_);
  act_due_.reset();
}

void Panel::choose_next(Ui& ui, PanelPort& port, int by) {
  const Build* build = port.build();
  if (!build || build->entries->empty()) return;
  const auto& entries = *build->entries;
  const auto count = static_cast<int>(entries.size());
  const auto at = std::ranges::find(entries, chosen_, &StackEntry::name);
  const int index = at == entries.end() ? (by > 0 ? 0 : count - 1)
                                        : std::clamp(static_cast<int>(at - entries.begin()) + by, 0, count - 1);
  chosen_ = entries[static_cast<std::size_t>(index)].name;
  scroll_to_chosen_ = true;
  ui.say("chosen: " + chosen_);
}

/// All of them: to the clipboard as one would write them, and for `paste_settings`.
void Panel::copy_settings(Ui& ui, PanelPort& port, const StackEntry& entry) {
  const EffectSchema& schema = port.preset()->schema(entry.effect);
  copied_ = {entry.effect, {}};
  std::string text;
  for (std::size_t i = 0; i < schema.settings.size() && i < entry.settings.size(); ++i) {
    const auto& [name, value] = entry.settings[i];
    copied_.values.push_back({"", name, value});
    if (!(value == schema.settings[i].default_value))
      text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", name, value.text());
  }
  for (const auto& history : port.build()->explanation->entries)
    if (history.name == entry.name)
      for (const auto& setting : history.composition)
        if (!setting.name.starts_with("mask.")) copied_.values.push_back({"", setting.name, setting.value});
  ui.copy(fmt::format("fx.{} {{ {} }},", entry.effect, text));
  ui.say(fmt::format("settings of {} copied", entry.name));
}

/// One step: those that the entry has too, where they differ.
void Panel::paste_settings(Ui& ui, PanelPort& port, const StackEntry& entry) {
  if (copied_.values.empty()) return ui.say("No settings were copied: Ctrl+Shift+C does");
  std::vector<SettingEdit> values;
  for (const SettingEdit& value : copied_.values) {
    const auto schema = port.preset()->setting_schema(entry, value.setting);
    if (!schema || schema->type != value.value.type ||
        (entry.effect != copied_.effect && !script::check_value("", *schema, value.value)))
      continue;
    const auto edited = port.edits().value(entry.name, value.setting);
    const auto base = base_value(*port.build(), entry.name, value.setting);
    const auto now = edited ? edited : base;
    if (!now || !same_value(*now, value.value)) values.push_back({entry.name, value.setting, value.value});
  }
  if (values.empty()) return ui.say(fmt::format("{} has these settings already", entry.name));
  port.end_gesture();
  port.set_all(values);
  port.end_gesture();
  ui.say(fmt::format("{} pasted into {}", values.size() == 1 ? "1 setting" : fmt::format("{} settings", values.size()),
                     entry.name));
}

void Panel::draw_entry_menu(Ui& ui, PanelPort& port, const StackEntry& entry) {
  if (!ImGui::BeginPopup("entry")) return;
  const bool written = in_file(entry, save_.file());
  const auto item = [&](const char* label, Action key, EntryAction action, bool enabled) {
    if (ImGui::MenuItem(label, keys_of(key).c_str(), false, enabled)) act(ui, port, action);
  };
  item("Earlier", Action::entry_earlier, EntryAction::earlier, written);
  item("Later", Action::entry_later, EntryAction::later, written);
  item("Duplicate", Action::duplicate_entry, EntryAction::duplicate, written);
  item("Remove", Action::remove_entry, EntryAction::remove, written);
  if (!written) ImGui::TextDisabled("It is made in another file");
  ImGui::Separator();
  item("Copy settings", Action::copy_settings, EntryAction::copy, true);
  item("Paste settings", Action::paste_settings, EntryAction::paste, !copied_.values.empty());
  ImGui::Separator();
  if (ImGui::BeginMenu("Mask")) {
    draw_mask_menu(entry);
    ImGui::EndMenu();
  }
  ImGui::EndPopup();
}

void Panel::draw_mask_menu(const StackEntry& entry) {
  if (ImGui::MenuItem("None", nullptr, !entry.mask, entry.mask != nullptr)) stack_.begin({Kind::mask, entry.name, ""});
  if (library_.masks().empty()) ImGui::TextDisabled("Reading…");
  for (const EffectSchema& mask : library_.masks()) {
    const bool has = entry.mask && entry.mask->text() == mask.name;
    if (ImGui::MenuItem(mask.name.c_str(), nullptr, has, !entry.mask))
      stack_.begin({Kind::mask, entry.name, mask.name});
  }
}

}  // namespace afterglow
