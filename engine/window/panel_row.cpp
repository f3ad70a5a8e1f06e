// SPDX-License-Identifier: MIT
#include "window/panel_row.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/text.h"
#include "script/explanation.h"
#include "window/setting_widget.h"

namespace afterglow {
namespace {

// Why the value is not the one that the file says in plain digits; empty when it is.
std::string origin_of(const SettingHistory& history) {
  if (!history.volumes.empty()) return fmt::format("volume {}", history.volumes.back().volume);
  if (history.preset && history.kind != "fixed") return history.kind;
  return {};
}

std::string setting_help(const SettingSchema& schema, const SettingHistory* history, bool edited) {
  std::string out = schema.doc;
  std::string facts = script::range_text(schema);
  if (!schema.unit.empty()) facts += (facts.empty() ? "in " : " ") + schema.unit;
  if (!facts.empty()) out += "\n" + facts;
  out += "\ndefault " + schema.default_value.text();
  if (history && history->preset) out += fmt::format("\nin the preset {} ({})", history->preset->text(), history->kind);
  if (history)
    for (const auto& step : history->volumes)
      out += fmt::format("\nvolume {} × {}: {}", step.volume, number_text(step.factor), step.value.text());
  if (edited) out += "\nchanged here; right-click to take it back";
  return out;
}

}  // namespace

void beside(const char* label) {
  const ImGuiStyle& style = ImGui::GetStyle();
  const float end =
      ImGui::GetItemRectMax().x + style.ItemSpacing.x + ImGui::CalcTextSize(label).x + 2 * style.FramePadding.x;
  if (end <= ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x) ImGui::SameLine();
}

bool small_button(const Ui& ui, const char* label, const char* help, bool enabled) {
  ImGui::BeginDisabled(!enabled);
  const bool pressed = ImGui::SmallButton(label);
  ImGui::EndDisabled();
  ui.help(help);
  return pressed && enabled;
}

namespace {

/// The file has another value than the one that was changed: both, and a way to each.
void draw_conflict(const Ui& ui, PanelPort& port, EditBases& bases, const EditConflict& conflict) {
  const std::string entry = conflict.entry, setting = conflict.setting;
  ImGui::PushStyleColor(ImGuiCol_Text, ui_color::kWarning);
  ImGui::TextWrapped("The file says %s now (it was %s)", conflict.now.text().c_str(), conflict.was.text().c_str());
  ImGui::PopStyleColor();
  const bool mine = small_button(ui, "Keep mine", "The value above stays, and is written over the file's by Save");
  ImGui::SameLine();
  const bool theirs = small_button(ui, "Take the file's", "The value that the file has now");
  if (mine) bases.keep(entry, setting);
  if (theirs) {
    port.end_gesture();
    port.reset(entry, setting);
    port.end_gesture();
  }
}

}  // namespace

void draw_row(Ui& ui, PanelPort& port, EditBases& bases, const PanelRow& row) {
  const SettingSchema& schema = row.schema;
  const SettingHistory* history = row.history;
  const auto edit = port.edits().value(row.entry, row.name);
  const SettingValue value = edit ? *edit : row.value;

  ImGui::PushID(row.name.c_str());
  const float width = std::max(ui.px(120), ImGui::GetContentRegionAvail().x * 0.52f);
  const auto changed = setting_widget(ui, "##value", schema, value, width);
  if (ui.typed.take_back()) port.take_back();
  if (changed) port.set(row.entry, row.name, *changed);
  if (ImGui::IsItemDeactivated()) port.end_gesture();
  if (ui.item_menu && ImGui::IsItemFocused()) ImGui::OpenPopup("more");
  if (ImGui::BeginPopupContextItem("more")) {
    if (ImGui::MenuItem("As in the file", nullptr, false, edit.has_value())) port.reset(row.entry, row.name);
    if (ImGui::MenuItem("Default", nullptr, false, !(value == schema.default_value)))
      port.set(row.entry, row.name, schema.default_value);
    port.end_gesture();
    ImGui::EndPopup();
  }
  ui.help(setting_help(schema, history, edit.has_value()));
  ImGui::SameLine(schema.type == SettingType::boolean
                      ? width + ImGui::GetStyle().WindowPadding.x + ImGui::GetStyle().ItemSpacing.x
                      : 0);
  const ImU32 color = edit ? ui_color::kAccent : row.said ? ui_color::kText : ui_color::kDim;
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  ImGui::TextUnformatted(row.name.c_str());
  ImGui::PopStyleColor();
  ui.help(setting_help(schema, history, edit.has_value()));
  if (const std::string origin = history ? origin_of(*history) : ""; !origin.empty()) {
    ImGui::SameLine();
    ImGui::TextDisabled("%s%s", edit ? "over " : "", origin.c_str());
  }
  if (edit) {
    ImGui::SameLine();
    if (small_button(ui, "x", "As in the file")) {
      port.end_gesture();
      port.reset(row.entry, row.name);
      port.end_gesture();
    }
  }
  if (const EditConflict* conflict = bases.find(row.entry, row.name)) draw_conflict(ui, port, bases, *conflict);
  ImGui::PopID();
}

}  // namespace afterglow
