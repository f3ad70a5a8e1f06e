// SPDX-License-Identifier: MIT
#include "window/sheet.h"

#include <imgui_internal.h>

namespace afterglow {

namespace {

constexpr ImGuiWindowFlags kOverlay = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                      ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                                      ImGuiWindowFlags_NoNav | ImGuiWindowFlags_AlwaysAutoResize;

}  // namespace

void begin_sheet(const char* name, ImVec2 at, ImVec2 pivot, const Ui& ui, ImGuiWindowFlags more) {
  // Its size is known from its second frame on; others make way for it then.
  const ImGuiWindow* known = ImGui::FindWindowByName(name);
  const ImVec2 corner = ui.sheets.place(at, pivot, known ? known->Size : ImVec2(0, 0));
  ImGui::SetNextWindowPos(known ? corner : at, ImGuiCond_Always, known ? ImVec2(0, 0) : pivot);
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
