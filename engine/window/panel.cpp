#include "window/panel.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/text.h"
#include "script/build.h"
#include "window/setting_widget.h"
#include "window/view_controls.h"

namespace afterglow {
namespace {

const std::string* reason_of(const std::vector<Skipped>& list, const std::string& name) {
  for (const auto& skipped : list)
    if (skipped.name == name) return &skipped.reason;
  return nullptr;
}

const SettingHistory* history_of(const Build& build, std::size_t entry, std::size_t setting) {
  const auto& entries = build.explanation->entries;
  if (entry >= entries.size() || setting >= entries[entry].settings.size()) return nullptr;
  return &entries[entry].settings[setting];
}

// Why the value is not the one that the file says in plain digits; empty when it is.
std::string origin_of(const SettingHistory& history) {
  if (!history.volumes.empty()) return fmt::format("volume {}", history.volumes.back().volume);
  if (history.preset && history.kind != "fixed") return history.kind;
  return {};
}

std::string range_of(const SettingSchema& schema) {
  if (schema.min && schema.max) return number_text(*schema.min) + "…" + number_text(*schema.max);
  if (schema.min) return "≥ " + number_text(*schema.min);
  if (schema.max) return "≤ " + number_text(*schema.max);
  return {};
}

void tooltip(const Ui& ui, const std::string& text) {
  if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(ui.px(360));
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

std::string setting_help(const SettingSchema& schema, const SettingHistory* history, bool edited) {
  std::string out = schema.doc;
  std::string facts = range_of(schema);
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

bool small_button(const Ui& ui, const char* label, const char* help, bool enabled = true) {
  ImGui::BeginDisabled(!enabled);
  const bool pressed = ImGui::SmallButton(label);
  ImGui::EndDisabled();
  tooltip(ui, help);
  return pressed && enabled;
}

bool is_edited(const SettingEdits& edits, const std::string& entry) {
  return std::any_of(edits.edits().begin(), edits.edits().end(), [&](const auto& edit) { return edit.entry == entry; });
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

void Panel::turn(Ui& ui, PanelPort& port) {
  if (save_.poll(port)) ui.say(save_.message());
  if (save_.busy()) ui.again();
}

void Panel::draw(Ui& ui, PanelPort& port, ImVec2 place, ImVec2 size) {
  turn(ui, port);
  ImGui::SetNextWindowPos(place);
  ImGui::SetNextWindowSize(size);
  constexpr int kFlags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                         ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus;
  if (ImGui::Begin("Settings", nullptr, kFlags)) {
    draw_head(ui, port);
    draw_outcome(ui);
    if (ImGui::CollapsingHeader("View")) draw_view_controls(ui, port);
    draw_entries(ui, port);
  }
  ImGui::End();
}

void Panel::draw_head(Ui& ui, PanelPort& port) {
  const Preset* preset = port.preset();
  ImGui::PushFont(ui.bold);
  ImGui::TextUnformatted(preset ? preset->name().c_str() : "No preset yet");
  ImGui::PopFont();
  tooltip(ui, save_.file().string());
  const SettingEdits& edits = port.edits();
  const bool changed = !edits.edits().empty();
  if (small_button(ui, save_.busy() ? "Saving…" : "Save preset", "Write the changes into the preset's file (Ctrl+S)",
                   changed && !save_.busy()))
    save(port);
  ImGui::SameLine();
  if (small_button(ui, "Undo save", "The file as it was before the last save", save_.can_undo())) undo_save(port);
  if (small_button(ui, "Undo", "Ctrl+Z", edits.can_undo())) port.undo();
  ImGui::SameLine();
  if (small_button(ui, "Redo", "Ctrl+Shift+Z", edits.can_redo())) port.redo();
  ImGui::SameLine();
  if (small_button(ui, "Reset all", "All settings as the file has them", changed)) {
    port.end_gesture();
    port.reset_all();
  }
  if (focus_search_) ImGui::SetKeyboardFocusHere();
  focus_search_ = false;
  ImGui::SetNextItemWidth(-1);
  ImGui::InputTextWithHint("##search", "Search settings", search_.data(), search_.size(),
                           ImGuiInputTextFlags_AutoSelectAll);
}

// What came of the last save, with all that was left out and why.
void Panel::draw_outcome(Ui& ui) {
  if (save_.message().empty()) return;
  const auto line = [](ImU32 color, const std::string& text) {
    ImGui::PushStyleColor(ImGuiCol_Text, color);
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
  };
  line(save_.failed() ? ui_color::kError : ui_color::kGood, save_.message());
  std::string all = save_.message();
  for (const auto& refused : save_.refused()) {
    line(ui_color::kWarning, refused.reason.text());
    all += "\n" + refused.reason.text();
  }
  for (const auto& note : save_.notes()) line(ui_color::kDim, note);
  if (small_button(ui, "Copy", "The messages, to the clipboard")) ui.copy(all);
  ImGui::SameLine();
  if (small_button(ui, "Dismiss", "Hide the messages")) save_.dismiss();
  ImGui::Separator();
}

void Panel::draw_entries(Ui& ui, PanelPort& port) {
  const Build* build = port.build();
  if (!build) return;
  if (build->entries->empty()) ImGui::TextDisabled("The stack has no effects");
  for (std::size_t i = 0; i < build->entries->size(); ++i) draw_entry(ui, port, i);
}

void Panel::draw_entry(Ui& ui, PanelPort& port, std::size_t index) {
  const Preset& preset = *port.preset();
  const StackEntry& entry = (*port.build()->entries)[index];
  const EffectSchema& schema = preset.schema(entry.effect);
  const bool whole = found(entry.name) || found(entry.effect);
  const auto shows = [&](const SettingSchema& setting) { return whole || found(setting.name) || found(setting.doc); };
  if (!whole && std::none_of(schema.settings.begin(), schema.settings.end(), shows)) return;

  ImGui::PushID(entry.name.c_str());
  const std::string* skipped = reason_of(port.skipped(), entry.name);
  if (search_[0] != '\0') ImGui::SetNextItemOpen(true);
  if (draw_entry_head(ui, port, entry, skipped)) {
    if (skipped) ImGui::PushStyleColor(ImGuiCol_Text, ui_color::kDim);
    if (skipped) ImGui::TextWrapped("skipped: %s", skipped->c_str());
    for (std::size_t i = 0; i < schema.settings.size() && i < entry.settings.size(); ++i)
      if (shows(schema.settings[i])) draw_setting(ui, port, index, i);
    if (skipped) ImGui::PopStyleColor();
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
  tooltip(ui, "Run this effect");
  ImGui::SameLine();
  const bool dim = skipped || !on, changed = is_edited(port.edits(), entry.name);
  if (dim || changed) ImGui::PushStyleColor(ImGuiCol_Text, dim ? ui_color::kDim : ui_color::kAccent);
  const std::string title = fmt::format("{}{}###head", entry.name, changed ? " •" : "");
  const bool open =
      ImGui::CollapsingHeader(title.c_str(), ImGuiTreeNodeFlags_DefaultOpen | ImGuiTreeNodeFlags_AllowItemOverlap);
  if (dim || changed) ImGui::PopStyleColor();
  tooltip(ui, fmt::format("{}\n{}, order {}\n{}:{}{}", port.preset()->schema(entry.effect).doc, entry.at, entry.order,
                          entry.file, entry.line, skipped ? "\nskipped: " + *skipped : ""));
  const double cost = cost_of(entry.name, port.times());
  const std::string label = cost >= 0 ? fmt::format("{:.2f} ms", cost) : "";
  float right = ImGui::GetWindowContentRegionMax().x;
  if (changed) {
    right -= ImGui::CalcTextSize("Reset").x + 2 * ImGui::GetStyle().FramePadding.x;
    ImGui::SameLine(right);
    if (small_button(ui, "Reset", "This effect as the file has it")) {
      port.end_gesture();
      const std::vector<SettingEdit> edits = port.edits().edits();
      for (const auto& edit : edits)
        if (edit.entry == entry.name) port.reset(edit.entry, edit.setting);
      port.end_gesture();
    }
  }
  if (!label.empty()) {
    ImGui::SameLine(right - ImGui::CalcTextSize(label.c_str()).x - ui.px(8));
    ImGui::TextDisabled("%s", label.c_str());
  }
  return open;
}

void Panel::draw_setting(Ui& ui, PanelPort& port, std::size_t entry_index, std::size_t index) {
  const Preset& preset = *port.preset();
  const StackEntry& entry = (*port.build()->entries)[entry_index];
  const SettingSchema& schema = preset.schema(entry.effect).settings[index];
  const SettingHistory* history = history_of(*port.build(), entry_index, index);
  const auto edit = port.edits().value(entry.name, schema.name);
  const SettingValue value = edit ? *edit : entry.settings[index].second;

  ImGui::PushID(schema.name.c_str());
  const float width = std::max(ui.px(120), ImGui::GetContentRegionAvail().x * 0.52f);
  if (const auto changed = setting_widget(ui, "##value", schema, value, width))
    port.set(entry.name, schema.name, *changed);
  if (ImGui::IsItemDeactivated()) port.end_gesture();
  const bool in_file = history && history->preset;
  if (ImGui::BeginPopupContextItem("more")) {
    if (ImGui::MenuItem("As in the file", nullptr, false, edit.has_value())) port.reset(entry.name, schema.name);
    if (ImGui::MenuItem("Default", nullptr, false, !(value == schema.default_value)))
      port.set(entry.name, schema.name, schema.default_value);
    port.end_gesture();
    ImGui::EndPopup();
  }
  tooltip(ui, setting_help(schema, history, edit.has_value()));
  ImGui::SameLine(schema.type == SettingType::boolean
                      ? width + ImGui::GetStyle().WindowPadding.x + ImGui::GetStyle().ItemSpacing.x
                      : 0);
  const ImU32 color = edit ? ui_color::kAccent : in_file ? ui_color::kText : ui_color::kDim;
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  ImGui::TextUnformatted(schema.name.c_str());
  ImGui::PopStyleColor();
  tooltip(ui, setting_help(schema, history, edit.has_value()));
  if (const std::string origin = history ? origin_of(*history) : ""; !origin.empty()) {
    ImGui::SameLine();
    ImGui::TextDisabled("%s%s", edit ? "over " : "", origin.c_str());
  }
  if (edit) {
    ImGui::SameLine();
    if (small_button(ui, "x", "As in the file")) {
      port.end_gesture();
      port.reset(entry.name, schema.name);
      port.end_gesture();
    }
  }
  ImGui::PopID();
}

}  // namespace afterglow
