// SPDX-License-Identifier: MIT
#include "window/view_controls.h"

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

}  // namespace

void draw_view_controls(Ui& ui, PanelPort& port) {
  View& view = port.view();
  ImGui::PushItemWidth(ImGui::GetContentRegionAvail().x * 0.6f);
  draw_image_picker(ui, port);
  float exposure = static_cast<float>(view.exposure);
  if (ImGui::SliderFloat("exposure", &exposure, -10, 10, "%+.2f EV")) view.exposure = exposure;
  if (ImGui::IsItemClicked(ImGuiMouseButton_Right)) view.exposure = 0;
  ui.help("Of the view alone, before encoding for the screen (Up, Down, 0); right-click for 0");
  if (ImGui::BeginCombo("channel", view_channel_name(view.channel).c_str())) {
    for (const ViewChannel channel : kChannels)
      if (ImGui::Selectable(view_channel_name(channel).c_str(), channel == view.channel)) view.channel = channel;
    ImGui::EndCombo();
  }
  ui.help("C, R, G, B, A, Y");
  draw_comparison(ui, port);
  draw_guide_controls(ui, view);
  ImGui::PopItemWidth();
  ImGui::Checkbox("false colour", &view.false_color);
  ui.help("Marks values below 0, above 1, and what is not finite (X)");
  ImGui::SameLine();
  ImGui::Checkbox("histogram", &ui.show_histogram);
  ui.help("H");
  ImGui::SameLine();
  ImGui::Checkbox("figures", &ui.show_stats);
  ui.help("Frame times and reload latency (Shift+S)");
}

}  // namespace afterglow
