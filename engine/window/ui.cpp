// SPDX-License-Identifier: MIT
#include "window/ui.h"

#include "core/printable.h"

namespace afterglow {

void Ui::help(const std::string& text) const {
  if (text.empty() || !ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
  const ImGuiIO& io = ImGui::GetIO();
  const bool held = io.MouseDown[0] || io.MouseDown[1] || io.MouseDown[2];
  if (!hover.due(ImGui::GetItemRectMin(), io.MousePos, held, now)) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(px(360));
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

std::string shortened(const std::string& text, float width) {
  const auto fits = [&](const std::string& part) { return ImGui::CalcTextSize(part.c_str()).x <= width; };
  if (fits(text)) return text;
  std::string part = text;
  while (!part.empty()) {
    part = cut_utf8(part, part.size() - 1);
    if (fits(part + "…")) break;
  }
  return part + "…";
}

bool wants_menu(const Ui& ui) {
  return ImGui::IsItemClicked(ImGuiMouseButton_Right) || (ui.item_menu && ImGui::IsItemFocused());
}

bool escape_pressed() {
#if IMGUI_VERSION_NUM >= 18700
  return ImGui::IsKeyPressed(ImGuiKey_Escape, false);
#else
  return ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape), false);
#endif
}

void focus_next_item() {
  ImGui::SetWindowFocus();  // Dear ImGui 1.90.1 gives it to items of the focused window alone
  ImGui::SetKeyboardFocusHere();
}

bool double_clicked() {
  const int clicks = ImGui::GetMouseClickedCount(ImGuiMouseButton_Left);
  return clicks > 0 && clicks % 2 == 0;
}

}  // namespace afterglow
