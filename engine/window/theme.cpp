// SPDX-License-Identifier: MIT
#include "window/theme.h"

#include <imgui.h>

namespace afterglow {

namespace {

ImVec4 gray(int level, float alpha = 1) {
  const float v = static_cast<float>(level) / 255;
  return {v, v, v * 1.02f, alpha};
}

ImVec4 accent(float strength, float alpha = 1) { return {1.0f * strength, 0.62f * strength, 0.24f * strength, alpha}; }

}  // namespace

void apply_theme(float scale) {
  ImGuiStyle& style = ImGui::GetStyle();
  style = ImGuiStyle();
  style.WindowPadding = {12, 10};
  style.FramePadding = {8, 4};
  style.ItemSpacing = {8, 6};
  style.ItemInnerSpacing = {6, 4};
  style.IndentSpacing = 16;
  style.ScrollbarSize = 12;
  style.GrabMinSize = 10;
  style.WindowBorderSize = 0;
  style.FrameBorderSize = 0;
  style.PopupBorderSize = 1;
  style.WindowRounding = 0;
  style.ChildRounding = 4;
  style.FrameRounding = 4;
  style.PopupRounding = 4;
  style.GrabRounding = 3;
  style.ScrollbarRounding = 6;
  style.ScaleAllSizes(scale);

  ImVec4* c = style.Colors;
  c[ImGuiCol_Text] = {0.87f, 0.875f, 0.885f, 1};
  c[ImGuiCol_TextDisabled] = {0.60f, 0.615f, 0.645f, 1};
  c[ImGuiCol_WindowBg] = gray(30);
  c[ImGuiCol_ChildBg] = gray(30, 0);
  c[ImGuiCol_PopupBg] = gray(36, 0.98f);
  c[ImGuiCol_Border] = gray(62);
  c[ImGuiCol_BorderShadow] = gray(0, 0);
  c[ImGuiCol_FrameBg] = gray(46);
  c[ImGuiCol_FrameBgHovered] = gray(56);
  c[ImGuiCol_FrameBgActive] = gray(64);
  c[ImGuiCol_TitleBg] = c[ImGuiCol_TitleBgActive] = c[ImGuiCol_TitleBgCollapsed] = gray(36);
  c[ImGuiCol_MenuBarBg] = gray(36);
  c[ImGuiCol_ScrollbarBg] = gray(30, 0);
  c[ImGuiCol_ScrollbarGrab] = gray(66);
  c[ImGuiCol_ScrollbarGrabHovered] = gray(84);
  c[ImGuiCol_ScrollbarGrabActive] = gray(100);
  c[ImGuiCol_CheckMark] = accent(1);
  // Values are written over them.
  c[ImGuiCol_SliderGrab] = c[ImGuiCol_SliderGrabActive] = accent(0.54f);
  c[ImGuiCol_Button] = gray(52);
  c[ImGuiCol_ButtonHovered] = gray(66);
  c[ImGuiCol_ButtonActive] = gray(78);
  c[ImGuiCol_Header] = gray(42);
  c[ImGuiCol_HeaderHovered] = gray(47);
  c[ImGuiCol_HeaderActive] = gray(50);
  c[ImGuiCol_Separator] = gray(48);
  c[ImGuiCol_SeparatorHovered] = gray(80);
  c[ImGuiCol_SeparatorActive] = accent(0.8f);
  c[ImGuiCol_ResizeGrip] = gray(60, 0);
  c[ImGuiCol_Tab] = gray(38);
  c[ImGuiCol_TabHovered] = gray(60);
  c[ImGuiCol_TabActive] = gray(52);
  c[ImGuiCol_PlotLines] = accent(0.9f);
  c[ImGuiCol_PlotHistogram] = accent(0.54f);  // words stand over it
  c[ImGuiCol_TableHeaderBg] = gray(40);
  c[ImGuiCol_TableBorderStrong] = c[ImGuiCol_TableBorderLight] = gray(48);
  c[ImGuiCol_TextSelectedBg] = accent(0.8f, 0.35f);
  c[ImGuiCol_NavHighlight] = accent(0.9f);
  c[ImGuiCol_ModalWindowDimBg] = gray(0, 0.5f);
}

}  // namespace afterglow
