// SPDX-License-Identifier: MIT
// The entries of the stack in the panel.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/text.h"
#include "script/build.h"
#include "script/explanation.h"
#include "window/panel.h"
#include "window/panel_row.h"

namespace afterglow {
namespace {

const std::string* reason_of(const std::vector<Skipped>& list, const std::string& name) {
  for (const auto& skipped : list)
    if (skipped.name == name) return &skipped.reason;
  return nullptr;
}

bool is_edited(const SettingEdits& edits, const std::string& entry) {
  return std::any_of(edits.edits().begin(), edits.edits().end(), [&](const auto& edit) { return edit.entry == entry; });
}

PanelRow row_of(const StackEntry& entry, const SettingHistory& history, const SettingSchema& schema,
                const SettingValue& value) {
  return {entry.name, history.name, schema, value, &history, history.preset.has_value()};
}

/// Is there a row for what was changed?
bool has_row(const Build& build, const SettingEdit& edit) {
  const auto& entries = build.explanation->entries;
  const auto entry = std::ranges::find(entries, edit.entry, &EntryHistory::name);
  return edit.entry.empty() ||
         (entry != entries.end() && (edit.setting == "enabled" || entry->find(edit.setting) != nullptr));
}

SettingValue boolean(bool on) { return {SettingType::boolean, {on ? 1.0 : 0.0}, ""}; }

}  // namespace

double cost_of(const std::string& entry, const std::vector<KernelTime>& times) {
  double sum = 0;
  bool known = false;
  for (const auto& kernel : times) {
    const auto passes = split(kernel.name, '+');
    const auto own = std::count_if(passes.begin(), passes.end(),
                                   [&](const std::string& pass) { return pass.substr(0, pass.find('.')) == entry; });
    if (own == 0) continue;
    known = true;
    sum += kernel.milliseconds * static_cast<double>(own) / static_cast<double>(passes.size());
  }
  return known ? sum : -1;
}

bool Panel::found(const std::string& text) const {
  return search_[0] == '\0' || lower(text).find(lower(search_.data())) != std::string::npos;
}

void Panel::draw_entries(Ui& ui, PanelPort& port) {
  const Build* build = port.build();
  if (!build) return;
  if (build->entries->empty()) ImGui::TextDisabled("The stack has no effects");
  for (std::size_t i = 0; i < build->entries->size(); ++i) draw_entry(ui, port, i);
  draw_lost(ui, port, *build);
}

/// Changes of what the file no longer has: Save leaves them out.
void Panel::draw_lost(const Ui& ui, PanelPort& port, const Build& build) {
  std::vector<SettingEdit> lost;
  std::ranges::copy_if(port.edits().edits(), std::back_inserter(lost),
                       [&](const SettingEdit& edit) { return !has_row(build, edit); });
  if (lost.empty()) return;
  ImGui::PushStyleColor(ImGuiCol_Text, ui_color::kWarning);
  ImGui::TextWrapped("Changes of what the preset no longer has");
  ImGui::PopStyleColor();
  ImGui::PushID("lost");
  for (const SettingEdit& edit : lost) {
    const std::string name = edit.entry + "." + edit.setting;
    ImGui::PushID(name.c_str());
    if (small_button(ui, "x", "Take this change back")) {
      port.end_gesture();
      port.reset(edit.entry, edit.setting);
      port.end_gesture();
    }
    ImGui::SameLine();
    ImGui::TextWrapped("%s = %s", name.c_str(), edit.value.text().c_str());
    ImGui::PopID();
  }
  ImGui::PopID();
}

void Panel::draw_entry(Ui& ui, PanelPort& port, std::size_t index) {
  const Preset& preset = *port.preset();
  const StackEntry& entry = (*port.build()->entries)[index];
  const EffectSchema& schema = preset.schema(entry.effect);
  const bool whole = found(entry.name) || found(entry.effect);
  const auto shows = [&](const SettingSchema& setting) { return whole || found(setting.name) || found(setting.doc); };
  const EntryHistory& history = port.build()->explanation->entries[index];
  const auto matches = [&](const SettingHistory& setting) { return whole || found(setting.name); };
  if (!whole && std::ranges::none_of(schema.settings, shows) && std::ranges::none_of(history.composition, matches))
    return;

  ImGui::PushID(entry.name.c_str());
  const std::string* skipped = reason_of(port.skipped(), entry.name);
  if (search_[0] != '\0') ImGui::SetNextItemOpen(true);
  if (draw_entry_head(ui, port, entry, skipped)) {
    if (skipped) {
      ImGui::PushStyleColor(ImGuiCol_Text, ui_color::kDim);
      ImGui::TextWrapped("skipped: %s", skipped->c_str());
      ImGui::PopStyleColor();
    }
    for (std::size_t i = 0; i < schema.settings.size() && i < entry.settings.size(); ++i)
      if (shows(schema.settings[i]))
        draw_row(ui, port, bases_, row_of(entry, history.settings[i], schema.settings[i], entry.settings[i].second));
    for (const auto& setting : history.composition)
      if (const auto of = matches(setting) ? preset.setting_schema(entry, setting.name) : std::nullopt)
        draw_row(ui, port, bases_, row_of(entry, setting, *of, setting.value));
    if (entry.mask && (whole || found("mask"))) ImGui::TextDisabled("mask: %s", entry.mask->text().c_str());
    ImGui::Spacing();
  }
  ImGui::PopID();
}

// Switch, name, cost, reset. True while the settings below are to be seen.
bool Panel::draw_entry_head(Ui& ui, PanelPort& port, const StackEntry& entry, const std::string* skipped) {
  const auto edited = port.edits().value(entry.name, "enabled");
  bool on = edited ? edited->number[0] != 0 : entry.enabled;
  if (ImGui::Checkbox("##enabled", &on)) {
    port.end_gesture();
    port.set(entry.name, "enabled", boolean(on));
    port.end_gesture();
  }
  ui.help("Run this effect (Ctrl+E when it is chosen)");
  ImGui::SameLine();
  const bool dim = skipped || !on, changed = is_edited(port.edits(), entry.name);
  if (dim || changed) ImGui::PushStyleColor(ImGuiCol_Text, dim ? ui_color::kDim : ui_color::kAccent);
  const std::string title = fmt::format("{}{}###head", entry.name, changed ? " •" : "");
  const bool open =
      ImGui::CollapsingHeader(title.c_str(), ImGuiTreeNodeFlags_DefaultOpen | ImGuiTreeNodeFlags_AllowItemOverlap);
  if (dim || changed) ImGui::PopStyleColor();
  if (ImGui::IsItemClicked()) chosen_ = entry.name;
  if (chosen_ == entry.name) {  // a bar at its left, besides the colour
    const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
    ImGui::GetWindowDrawList()->AddRect(from, to, ui_color::kAccent, ui.px(4));
    if (std::exchange(scroll_to_chosen_, false)) ImGui::SetScrollHereY(0.3f);
  }
  ui.help(fmt::format("{}\n{}, order {}\n{}:{}{}", port.preset()->schema(entry.effect).doc, entry.at, entry.order,
                      entry.file, entry.line, skipped ? "\nskipped: " + *skipped : ""));
  draw_entry_end(ui, port, entry, changed);
  return open;
}

// Cost, reset, menu: at the right end of the head.
void Panel::draw_entry_end(Ui& ui, PanelPort& port, const StackEntry& entry, bool changed) {
  const float padding = 2 * ImGui::GetStyle().FramePadding.x;
  float right = ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize("…").x - padding;
  ImGui::SameLine(right);
  if (small_button(ui, "…", "Copy, move, mask or remove this effect")) {
    chosen_ = entry.name;
    read_library(port);
    ImGui::OpenPopup("entry");
  }
  if (changed) {
    right -= ImGui::CalcTextSize("Reset").x + padding + ui.px(4);
    ImGui::SameLine(right);
    if (small_button(ui, "Reset", "This effect as the file has it")) {
      port.end_gesture();
      const std::vector<SettingEdit> edits = port.edits().edits();
      for (const auto& edit : edits)
        if (edit.entry == entry.name) port.reset(edit.entry, edit.setting);
      port.end_gesture();
    }
  }
  const double cost = cost_of(entry.name, port.times());
  if (cost >= 0) {
    const std::string label = fmt::format("{:.2f} ms", cost);
    ImGui::SameLine(right - ImGui::CalcTextSize(label.c_str()).x - ui.px(8));
    ImGui::TextDisabled("%s", label.c_str());
  }
  draw_entry_menu(ui, port, entry);
}

}  // namespace afterglow
