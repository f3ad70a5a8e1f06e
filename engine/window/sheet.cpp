// SPDX-License-Identifier: MIT
#include "window/sheet.h"

#include <imgui_internal.h>

#include <algorithm>

namespace afterglow {

namespace {

constexpr ImGuiWindowFlags kOverlay = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                      ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                                      ImGuiWindowFlags_NoNav | ImGuiWindowFlags_AlwaysAutoResize;

}  // namespace

void begin_sheet(const char* name, ImVec2 at, ImVec2 pivot, const Ui& ui, ImGuiWindowFlags more) {
  // Larger than its place: its title is what stays to be read.
  if (const ImGuiWindow* known = ImGui::FindWindowByName(name)) {
    at.x = std::max(at.x, pivot.x * known->Size.x);
    at.y = std::max(at.y, pivot.y * known->Size.y);
  }
  ImGui::SetNextWindowPos(at, ImGuiCond_Always, pivot);
  ImGui::PushStyleColor(ImGuiCol_WindowBg, ui_color::kOverlay);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, ui.px(5));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(ui.px(10), ui.px(8)));
  ImGui::Begin(name, nullptr, kOverlay | more);
}

void end_sheet() {
  ImGui::End();
  ImGui::PopStyleVar(2);
  ImGui::PopStyleColor();
}

void colored(ImU32 color, const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopStyleColor();
}

}  // namespace afterglow
