// SPDX-License-Identifier: MIT
#include "window/view_controls.h"

#include <algorithm>
#include <iterator>
#include <string>

namespace afterglow {
namespace {

constexpr ViewChannel kChannels[] = {ViewChannel::color, ViewChannel::red,   ViewChannel::green,
                                     ViewChannel::blue,  ViewChannel::alpha, ViewChannel::luminance};

void draw_image_picker(const Ui& ui, PanelPort& port) {
  const std::string shown = port.shown_image();
  if (ImGui::BeginCombo("image", shown.empty() ? "result" : shown.c_str(), ImGuiComboFlags_HeightLarge)) {
    if (ImGui::Selectable("result", shown.empty())) port.show("");
    for (const auto& name : port.images())
      if (ImGui::Selectable(name.c_str(), name == shown)) port.show(name);
    ImGui::EndCombo();
  }
  ui.help("The result, or any image between passes (N, Shift+N, Backspace)");
}

void draw_comparison(const Ui& ui, PanelPort& port) {
  View& view = port.view();
  if (ImGui::BeginCombo("compare", compare_name(view.compare).c_str())) {
    for (const Compare compare : {Compare::none, Compare::source, Compare::other}) {
      if (compare == Compare::other && !port.has_other()) continue;
      if (ImGui::Selectable(compare_name(compare).c_str(), compare == view.compare)) view.compare = compare;
    }
    ImGui::EndCombo();
  }
  ui.help("With what went in, or the other preset's result");
  if (view.compare == Compare::none) return;
  if (ImGui::BeginCombo("by", compare_by_name(view.by).c_str())) {
    for (const CompareBy by : {CompareBy::wipe, CompareBy::flip, CompareBy::side_by_side, CompareBy::difference})
      if (ImGui::Selectable(compare_by_name(by).c_str(), by == view.by)) view.by = by;
    ImGui::EndCombo();
  }
  ui.help("A border between both (W), one in the other's place (E), side by side (V), difference (D)");
  if (!wipes(view)) return;
  float wipe = static_cast<float>(view.wipe);
  if (ImGui::SliderFloat("border", &wipe, 0, 1, "%.2f", ImGuiSliderFlags_AlwaysClamp)) view.wipe = wipe;
  ImGui::Checkbox("horizontal border", &view.wipe_vertical);
  ui.help("Shift+W");
}

/// Displays of the configuration, and views of the one that is shown on.
void draw_display_choice(const Ui& ui) {
  if (ui.displays.empty()) return;
  if (ImGui::BeginCombo("display", ui.display_name.c_str(), ImGuiComboFlags_HeightLarge)) {
    for (const auto& display : ui.displays)
      if (ImGui::Selectable(display.name.c_str(), display.name == ui.display_name)) ui.choose_display(display.name, "");
    ImGui::EndCombo();
  }
  ui.help("Of the OpenColorIO configuration");
  const auto shown = std::ranges::find(ui.displays, ui.display_name, &OcioSurvey::Display::name);
  if (shown == ui.displays.end()) return;
  if (ImGui::BeginCombo("view", ui.display_view.c_str(), ImGuiComboFlags_HeightLarge)) {
    for (const auto& view : shown->views)
      if (ImGui::Selectable(view.c_str(), view == ui.display_view)) ui.choose_display(shown->name, view);
    ImGui::EndCombo();
  }
  ui.help("Of that display (Ctrl+V: the next)");
}

void draw_guide_controls(const Ui& ui, View& view) {
  if (ImGui::BeginCombo("lines", guides_name(view.guides).c_str())) {
    for (const Guides guides : {Guides::none, Guides::thirds, Guides::safe_areas, Guides::both})
      if (ImGui::Selectable(guides_name(guides).c_str(), guides == view.guides)) view.guides = guides;
    ImGui::EndCombo();
  }
  ui.help("Over the picture (Shift+G); safe areas: 93 % for what happens, 90 % for titles");
  if (ImGui::BeginCombo("form", kAspects[view.aspect].name)) {
    for (std::size_t i = 0; i < std::size(kAspects); ++i)
      if (ImGui::Selectable(kAspects[i].name, i == view.aspect)) view.aspect = i;
    ImGui::EndCombo();
  }
  ui.help("Darkens what lies beside that form (Shift+A); files stay whole");
}

void draw_scope_controls(const Ui& ui, PanelPort& port) {
  View& view = port.view();
  if (ImGui::BeginCombo("scope", scope_kind_name(view.scope).c_str())) {
    for (int i = 0; i <= static_cast<int>(ScopeKind::all); ++i) {
      const auto kind = static_cast<ScopeKind>(i);
      if (ImGui::Selectable(scope_kind_name(kind).c_str(), kind == view.scope)) view.scope = kind;
    }
    ImGui::EndCombo();
  }
  ui.help("Of the result, not of how it is viewed (H)");
  if (ImGui::BeginCombo("levels", scope_scale_name(view.scope_scale).c_str())) {
    for (const ScopeScale scale : {ScopeScale::code, ScopeScale::linear, ScopeScale::stops})
      if (ImGui::Selectable(scope_scale_name(scale).c_str(), scale == view.scope_scale)) view.scope_scale = scale;
    ImGui::EndCombo();
  }
  ui.help("Of scopes: sRGB codes, linear light, or stops from middle grey (Shift+H)");
  bool on = view.region.has_value();
  if (ImGui::Checkbox("region", &on)) view.region = on ? std::optional(port.middle_region()) : std::nullopt;
  ui.help("Scopes and means are of this part of the picture alone (Ctrl+drag over the picture; Ctrl+H: none)");
  if (!view.region) return;
  int values[] = {view.region->x, view.region->y, view.region->width, view.region->height};
  if (ImGui::DragInt4("x y w h", values, 1, 0, 1 << 20, "%d", ImGuiSliderFlags_AlwaysClamp))
    view.region = Rect{values[0], values[1], std::max(values[2], 1), std::max(values[3], 1)};
  ui.help("Pixels of the picture, from its upper left corner; double click to type");
}

}  // namespace

void draw_view_controls(Ui& ui, PanelPort& port) {
  View& view = port.view();
  ImGui::PushItemWidth(ImGui::GetContentRegionAvail().x * 0.6f);
  draw_image_picker(ui, port);
  float exposure = static_cast<float>(view.exposure);
  constexpr auto kMost = static_cast<float>(kMostExposure);
  if (ImGui::SliderFloat("exposure", &exposure, -kMost, kMost, "%+.2f EV", ImGuiSliderFlags_AlwaysClamp))
    view.exposure = exposure;
  if (wants_menu(ui)) view.exposure = 0;
  ui.help("Of the view alone, before encoding for the screen (Up, Down, 0); right-click for 0");
  float gamma = static_cast<float>(view.gamma);
  if (ImGui::SliderFloat("gamma", &gamma, 0.25f, 4, "%.2f", ImGuiSliderFlags_AlwaysClamp)) view.gamma = gamma;
  if (wants_menu(ui)) view.gamma = 1;
  ui.help("Of the view alone, behind the exposure (Shift+Up, Shift+Down, 0); right-click for 1");
  if (ImGui::BeginCombo("channel", view_channel_name(view.channel).c_str())) {
    for (const ViewChannel channel : kChannels)
      if (ImGui::Selectable(view_channel_name(channel).c_str(), channel == view.channel)) view.channel = channel;
    ImGui::EndCombo();
  }
  ui.help("C, R, G, B, A, Y");
  if (!ui.display.empty()) {
    ImGui::Checkbox("as the display has it", &view.as_display);
    ui.help(ui.display + " (Shift+V); files stay without it");
    draw_display_choice(ui);
  }
  draw_comparison(ui, port);
  draw_guide_controls(ui, view);
  if (ImGui::BeginCombo("marks", marks_name(view.marks).c_str())) {
    for (const Marks marks : {Marks::none, Marks::range, Marks::stops})
      if (ImGui::Selectable(marks_name(marks).c_str(), marks == view.marks)) view.marks = marks;
    ImGui::EndCombo();
  }
  ui.help("What is below 0, above 1 or not finite, or a colour for each stop of luminance (X)");
  draw_scope_controls(ui, port);
  ImGui::PopItemWidth();
  ImGui::Checkbox("figures", &ui.show_stats);
  ui.help("Frame times and reload latency (Shift+S)");
}

}  // namespace afterglow
