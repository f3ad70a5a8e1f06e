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

/// What begins with this entry: a look of a mix; null: nothing.
const char* side_of_mix(const std::vector<StackEntry>& entries, std::size_t i) {
  for (std::size_t mix = 0; mix < i; ++mix) {
    if (!entries[mix].is_mix()) continue;
    if (entries[mix].middle_of(mix) == i && entries[mix].end_of(mix) > i) return "second look";
    if (entries[mix].first_of(mix) == i && entries[mix].middle > 0) return "first look";
  }
  return nullptr;
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
  const std::vector<StackEntry>& entries = *build->entries;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    // Members stand further in than their group.
    const float inside = ui.px(14) * static_cast<float>(entries[i].depth);
    if (inside > 0) ImGui::Indent(inside);
    if (const char* side = side_of_mix(entries, i); side && search_[0] == '\0') ImGui::TextDisabled("%s", side);
    draw_entry(ui, port, i);
    if (inside > 0) ImGui::Unindent(inside);
  }
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
    for (std::size_t i = 0; i < schema.settings.size() && i < entry.settings.size(); ++i)
      if (shows(schema.settings[i]))
        draw_row(ui, port, bases_, row_of(entry, history.settings[i], schema.settings[i], entry.settings[i].second));
    for (const auto& setting : history.composition)
      if (const auto of = matches(setting) ? preset.setting_schema(entry, setting.name) : std::nullopt)
        draw_row(ui, port, bases_, row_of(entry, setting, *of, setting.value));
    if (entry.mask && (whole || found("mask"))) ImGui::TextDisabled("mask: %s", entry.mask->text().c_str());
    if (skipped) {  // below the settings: they stay where they are while one is dragged through the value that skips
      ImGui::PushStyleColor(ImGuiCol_Text, ui_color::kDim);
      ImGui::TextWrapped("skipped: %s", skipped->c_str());
      ImGui::PopStyleColor();
    }
    ImGui::Spacing();
  }
  ImGui::PopID();
}

/// What stands at the right end of a head, and how wide it is with the space before it.
struct Panel::EntryEnd {
  std::string label;  ///< cost, or that the entry is skipped; empty where the name needs the place
  bool changed = false;
  float label_width = 0, reset_width = 0, menu_width = 0;
  float width() const { return label_width + reset_width + menu_width; }
};

Panel::EntryEnd Panel::entry_end(const Ui& ui, PanelPort& port, const StackEntry& entry, bool skipped) const {
  const float padding = 2 * ImGui::GetStyle().FramePadding.x;
  const auto wide = [](const char* text) { return ImGui::CalcTextSize(text).x; };
  EntryEnd end{.changed = is_edited(port.edits(), entry.name)};
  end.menu_width = wide("…") + padding;
  if (end.changed) end.reset_width = wide("Reset") + padding + ui.px(4);
  const double cost = cost_of(entry.name, port.times());
  if (skipped) {
    end.label = "skipped";
  } else if (cost >= 0) {
    end.label = fmt::format("{:.2f} ms", cost);
  }
  if (!end.label.empty()) end.label_width = wide(end.label.c_str()) + ui.px(8);
  return end;
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
  EntryEnd end = entry_end(ui, port, entry, skipped != nullptr);
  const bool dim = skipped || !on, changed = end.changed;
  if (dim || changed) ImGui::PushStyleColor(ImGuiCol_Text, dim ? ui_color::kDim : ui_color::kAccent);
  const std::string mark = changed ? " •" : "";
  const float room = ImGui::GetContentRegionAvail().x - ImGui::GetTreeNodeToLabelSpacing() - ui.px(8) -
                     ImGui::CalcTextSize(mark.c_str()).x;
  if (ImGui::CalcTextSize(entry.name.c_str()).x > room - end.width()) end.label_width = 0;
  const std::string shown = shortened(entry.name, room - end.width());
  const std::string title = fmt::format("{}{}###head", shown, mark);
  const bool open =
      ImGui::CollapsingHeader(title.c_str(), ImGuiTreeNodeFlags_DefaultOpen | ImGuiTreeNodeFlags_AllowItemOverlap);
  if (dim || changed) ImGui::PopStyleColor();
  if (ImGui::IsItemClicked()) chosen_ = entry.name;
  if (chosen_ == entry.name) {  // a bar at its left, besides the colour
    const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
    ImGui::GetWindowDrawList()->AddRect(from, to, ui_color::kAccent, ui.px(4));
    if (std::exchange(scroll_to_chosen_, false)) ImGui::SetScrollHereY(0.3f);
  }
  ui.help(fmt::format("{}{}\n{}, order {}\n{}:{}{}", shown == entry.name ? "" : entry.name + ": ",
                      port.preset()->schema(entry.effect).doc, entry.at, entry.order, entry.file, entry.line,
                      skipped ? "\nskipped: " + *skipped : ""));
  draw_entry_end(ui, port, entry, end);
  return open;
}

// Cost, reset, menu: at the right end of the head.
void Panel::draw_entry_end(Ui& ui, PanelPort& port, const StackEntry& entry, const EntryEnd& end) {
  const float right = ImGui::GetWindowContentRegionMax().x;
  ImGui::SameLine(right - end.menu_width);
  if (small_button(ui, "…", "Copy, move, mask or remove this effect")) {
    chosen_ = entry.name;
    read_library(port);
    ImGui::OpenPopup("entry");
  }
  if (end.changed) {
    ImGui::SameLine(right - end.menu_width - end.reset_width);
    if (small_button(ui, "Reset", "This effect as the file has it")) {
      port.end_gesture();
      const std::vector<SettingEdit> edits = port.edits().edits();
      for (const auto& edit : edits)
        if (edit.entry == entry.name) port.reset(edit.entry, edit.setting);
      port.end_gesture();
    }
  }
  if (end.label_width > 0) {
    ImGui::SameLine(right - end.width());
    ImGui::TextDisabled("%s", end.label.c_str());
  }
  draw_entry_menu(ui, port, entry);
}

}  // namespace afterglow
