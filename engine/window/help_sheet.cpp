// SPDX-License-Identifier: MIT
#include "window/help_sheet.h"

#include <cstring>

#include "window/shortcuts.h"

namespace afterglow {
namespace {

// The keys of each action once, in one group.
void draw_group(const Ui& ui, const char* group) {
  ImGui::PushFont(ui.bold);
  ImGui::TextUnformatted(group);
  ImGui::PopFont();
  if (!ImGui::BeginTable(group, 2, ImGuiTableFlags_SizingFixedFit)) return;
  const Shortcut* last = nullptr;
  for (const Shortcut& shortcut : shortcuts()) {
    if (std::strcmp(shortcut.group, group) != 0) continue;
    const bool again = last && last->action == shortcut.action;
    last = &shortcut;
    if (again) continue;
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::PushFont(ui.mono);
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(ui_color::kAccent), "%s", keys_of(shortcut.action).c_str());
    ImGui::PopFont();
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(shortcut.doc);
  }
  ImGui::EndTable();
  ImGui::Spacing();
}

}  // namespace

void draw_help_sheet(Ui& ui, ImVec2 area) {
  if (!ui.show_help) return;
  ImGui::SetNextWindowPos({area.x / 2, area.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {area.x * 0.95f, area.y * 0.95f});
  constexpr int kFlags = ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                         ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings;
  ImGui::SetNextWindowFocus();
  if (ImGui::Begin("Keys", &ui.show_help, kFlags)) {
    ImGui::BeginGroup();
    const char* group = "";
    int rows = 0;
    const bool wide = area.x >= ui.px(1040);  // what two columns of the longest words take
    for (const Shortcut& shortcut : shortcuts()) {
      if (std::strcmp(shortcut.group, group) == 0) continue;
      group = shortcut.group;
      // Two columns of groups.
      if (rows++ == 2 && wide) {
        ImGui::EndGroup();
        ImGui::SameLine(0, ui.px(32));
        ImGui::BeginGroup();
      }
      draw_group(ui, group);
    }
    ImGui::EndGroup();
    ImGui::TextDisabled(
        "Wheel: zoom at the pointer. Drag: move the picture, or the wipe's border. Double click: between fit and 1:1.\n"
        "Double click (or Ctrl+click) a slider: type a value. Right click a setting: as in the file, or its default.");
  }
  ImGui::End();
}

}  // namespace afterglow
