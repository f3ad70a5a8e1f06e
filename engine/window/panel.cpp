// SPDX-License-Identifier: MIT
#include "window/panel.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/text.h"
#include "script/build.h"
#include "window/panel_row.h"
#include "window/view_controls.h"

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

std::string Panel::unsaved(PanelPort& port) const {
  if (save_.settling()) return {};
  const auto& edits = port.edits().edits();
  const auto count = std::ranges::count_if(edits, [](const SettingEdit& edit) { return !edit.entry.empty(); });
  if (count == 0) return {};
  return fmt::format("{} of {}", count == 1 ? "1 setting" : fmt::format("{} settings", count),
                     save_.file().filename().string());
}

void Panel::turn(Ui& ui, PanelPort& port) {
  if (save_.poll(port, bases_)) ui.say(save_.message());
  if (save_.busy()) ui.again();
  if (!save_.settling()) bases_.follow(port);
}

void Panel::draw(Ui& ui, PanelPort& port, ImVec2 place, ImVec2 size) {
  turn(ui, port);
  ImGui::SetNextWindowPos(place);
  ImGui::SetNextWindowSize(size);
  constexpr int kFlags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                         ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus;
  if (ImGui::Begin("Settings", nullptr, kFlags)) {
    draw_head(ui, port);
    if (ImGui::CollapsingHeader("View")) draw_view_controls(ui, port);
    draw_settings(ui, port);
    draw_outcome(ui);
  }
  ImGui::End();
}

/// While the file has an error the picture is that of the last good one: settings of a file that cannot be run are
/// shown, and rest.
void Panel::draw_settings(Ui& ui, PanelPort& port) {
  const bool broken = port.status().error.has_value();
  if (broken && port.build()) {
    ImGui::PushStyleColor(ImGuiCol_Text, ui_color::kWarning);
    ImGui::TextWrapped("The preset has an error. Settings rest until it is mended.");
    ImGui::PopStyleColor();
  }
  ui.values_apply = !broken;
  ImGui::BeginDisabled(broken);
  draw_arguments(ui, port);
  draw_entries(ui, port);
  ImGui::EndDisabled();
}

void Panel::draw_head(Ui& ui, PanelPort& port) {
  const Preset* preset = port.preset();
  ImGui::PushFont(ui.bold);
  ImGui::TextUnformatted(preset ? preset->name().c_str() : "No preset yet");
  ImGui::PopFont();
  ui.help(save_.file().string());
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
  if (std::exchange(focus_search_, false)) focus_next_item();
  ImGui::SetNextItemWidth(-1);
  ImGui::InputTextWithHint("##search", "Search settings", search_.data(), search_.size(),
                           ImGuiInputTextFlags_AutoSelectAll);
}

// What the last save left out and why, or why it failed, over the end of the panel: nothing moves for it. What went
// well is said over the picture for a moment.
void Panel::draw_outcome(Ui& ui) {
  if (!save_.failed() && save_.refused().empty() && save_.notes().empty()) return;
  std::vector<std::pair<ImU32, std::string>> lines{
      {save_.failed() ? ui_color::kError : ui_color::kGood, save_.message()}};
  for (const auto& refused : save_.refused()) lines.emplace_back(ui_color::kWarning, refused.reason.text());
  for (const auto& note : save_.notes()) lines.emplace_back(ui_color::kDim, note);

  const ImGuiStyle& style = ImGui::GetStyle();
  const float width = ImGui::GetWindowContentRegionMax().x - ImGui::GetWindowContentRegionMin().x;
  const float wrap = width - 2 * style.WindowPadding.x;
  float height = 2 * style.WindowPadding.y + ImGui::GetFrameHeightWithSpacing();
  std::string all;
  for (const auto& [color, text] : lines) {
    height += ImGui::CalcTextSize(text.c_str(), nullptr, false, wrap).y + style.ItemSpacing.y;
    all += (all.empty() ? "" : "\n") + text;
  }
  const ImVec2 at = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
  height = std::min(height, size.y * 0.6f);
  ImGui::SetCursorScreenPos({at.x + style.WindowPadding.x, at.y + size.y - style.WindowPadding.y - height});
  ImGui::PushStyleColor(ImGuiCol_ChildBg, ui_color::kOverlay);
  if (ImGui::BeginChild("outcome", {width, height}, true)) {
    for (const auto& [color, text] : lines) {
      ImGui::PushStyleColor(ImGuiCol_Text, color);
      ImGui::TextWrapped("%s", text.c_str());
      ImGui::PopStyleColor();
    }
    if (small_button(ui, "Copy", "The messages, to the clipboard")) ui.copy(all);
    ImGui::SameLine();
    if (small_button(ui, "Dismiss", "Hide the messages")) save_.dismiss();
  }
  ImGui::EndChild();
  ImGui::PopStyleColor();
}

// What the preset asks of whoever runs it. The preset's text stays: arguments are given with the command.
void Panel::draw_arguments(Ui& ui, PanelPort& port) {
  const Preset* preset = port.preset();
  if (!preset || preset->arguments().empty()) return;
  const auto shows = [&](const PresetArgument& argument) {
    return found(argument.schema.name) || found(argument.schema.doc) || found("arguments");
  };
  const auto& arguments = preset->arguments();
  if (std::ranges::none_of(arguments, shows)) return;
  ImGui::PushID("arguments");
  if (ImGui::CollapsingHeader("Arguments", ImGuiTreeNodeFlags_DefaultOpen)) {
    for (const auto& argument : arguments)
      if (shows(argument))
        draw_row(ui, port, bases_,
                 {"", argument.schema.name, argument.schema, argument.value, nullptr, argument.given});
    const std::string words = argument_words(port.edits());
    if (small_button(ui, "Copy --arg", ("To the clipboard: " + words).c_str(), !words.empty())) ui.copy(words);
    ImGui::Spacing();
  }
  ImGui::PopID();
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
  const EntryHistory& history = port.build()->explanation->entries[index];
  const auto matches = [&](const SettingHistory& setting) { return whole || found(setting.name); };
  if (!whole && std::ranges::none_of(schema.settings, shows) && std::ranges::none_of(history.composition, matches))
    return;

  ImGui::PushID(entry.name.c_str());
  const std::string* skipped = reason_of(port.skipped(), entry.name);
  if (search_[0] != '\0') ImGui::SetNextItemOpen(true);
  if (draw_entry_head(ui, port, entry, skipped)) {
    if (skipped) ImGui::PushStyleColor(ImGuiCol_Text, ui_color::kDim);
    if (skipped) ImGui::TextWrapped("skipped: %s", skipped->c_str());
    for (std::size_t i = 0; i < schema.settings.size() && i < entry.settings.size(); ++i)
      if (shows(schema.settings[i]))
        draw_row(ui, port, bases_, row_of(entry, history.settings[i], schema.settings[i], entry.settings[i].second));
    for (const auto& setting : history.composition)
      if (const auto of = matches(setting) ? preset.setting_schema(entry, setting.name) : std::nullopt)
        draw_row(ui, port, bases_, row_of(entry, setting, *of, setting.value));
    if (entry.mask && (whole || found("mask"))) ImGui::TextDisabled("mask: %s", entry.mask->text().c_str());
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
  ui.help("Run this effect");
  ImGui::SameLine();
  const bool dim = skipped || !on, changed = is_edited(port.edits(), entry.name);
  if (dim || changed) ImGui::PushStyleColor(ImGuiCol_Text, dim ? ui_color::kDim : ui_color::kAccent);
  const std::string title = fmt::format("{}{}###head", entry.name, changed ? " •" : "");
  const bool open =
      ImGui::CollapsingHeader(title.c_str(), ImGuiTreeNodeFlags_DefaultOpen | ImGuiTreeNodeFlags_AllowItemOverlap);
  if (dim || changed) ImGui::PopStyleColor();
  ui.help(fmt::format("{}\n{}, order {}\n{}:{}{}", port.preset()->schema(entry.effect).doc, entry.at, entry.order,
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

}  // namespace afterglow
