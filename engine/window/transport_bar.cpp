// SPDX-License-Identifier: MIT
#include "window/transport_bar.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace afterglow {
namespace {

// One control; true when pressed.
bool button(const Ui& ui, const char* label, const char* text) {
  const bool pressed = ImGui::Button(label, {ui.px(34), 0});
  Ui::help(text);
  ImGui::SameLine(0, ui.px(2));
  return pressed;
}

void draw_buttons(const Ui& ui, TransportBarState& state) {
  Transport& transport = state.transport;
  if (button(ui, "|<##first", "To the first frame of the range (Home)")) transport.go_to_first(state.now);
  if (button(ui, "<##back", "One frame back (Left)")) transport.step(-1, state.now);
  if (button(ui, transport.playing() ? "||###play" : ">###play", "Play or pause (Space)")) transport.toggle(state.now);
  if (button(ui, ">>##on", "One frame on (Right)")) transport.step(1, state.now);
  if (button(ui, ">|##last", "To the last frame of the range (End)")) transport.go_to_last(state.now);
  ImGui::SameLine(0, ui.px(10));
  if (ImGui::Button(fmt::format("{}###loop", loop_mode_name(transport.loop())).c_str(), {ui.px(84), 0})) {
    const auto next = static_cast<LoopMode>((static_cast<int>(transport.loop()) + 1) % 3);
    transport.set_loop(next, state.now);
  }
  Ui::help("What happens at the ends of the range (L)");
  ImGui::SameLine(0, ui.px(10));
  float speed = static_cast<float>(transport.speed());
  ImGui::SetNextItemWidth(ui.px(84));
  if (ImGui::DragFloat("##speed", &speed, 0.02f, -8, 8, "%.2fx") && std::abs(speed) >= Transport::kSlowest)
    transport.set_speed(speed, state.now);
  if (ImGui::IsItemClicked(ImGuiMouseButton_Right)) transport.set_speed(1, state.now);
  Ui::help("Speed; negative is backwards (, and .); right-click for 1");
  ImGui::SameLine(0, ui.px(4));
  float fps = static_cast<float>(transport.fps());
  ImGui::SetNextItemWidth(ui.px(84));
  if (ImGui::DragFloat("##fps", &fps, 0.1f, 1, 240, "%.3g fps", ImGuiSliderFlags_AlwaysClamp))
    transport.set_fps(fps, state.now);
  Ui::help("Frames a second at speed 1");
  ImGui::SameLine(0, ui.px(4));
  bool every = transport.pacing() == Pacing::every_frame;
  if (ImGui::Checkbox("every frame", &every))
    transport.set_pacing(every ? Pacing::every_frame : Pacing::real_time, state.now);
  Ui::help("As fast as it goes, without dropping frames, instead of by the clock");
}

void draw_figures(const Ui& ui, const TransportBarState& state) {
  const Transport& transport = state.transport;
  std::string text = state.shown >= 0
                         ? fmt::format("{}  {}/{}", state.number(state.shown), state.shown + 1, transport.frames())
                         : fmt::format("-/{}", transport.frames());
  if (transport.playing()) text += fmt::format("   {:.1f} fps", state.fps);
  if (transport.dropped() > 0) text += fmt::format("   {} dropped", transport.dropped());
  if (state.late > 0) text += fmt::format("   {} late", state.late);
  ImGui::PushFont(ui.mono);
  ImGui::SameLine(
      std::max(ImGui::GetCursorPosX(), ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(text.c_str()).x));
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopFont();
  if (!state.picture.empty()) Ui::help(state.picture.c_str());
}

struct Bar {
  ImVec2 begin, end;
  int frames;
  float width() const { return end.x - begin.x; }
  float left(int position) const {
    return begin.x + width() * static_cast<float>(position) / static_cast<float>(frames);
  }
};

// Runs of cached frames: one rectangle each, and no more than the bar has pixels.
void draw_cached(ImDrawList& list, const Ui& ui, const Bar& bar, const TransportBarState& state) {
  const int step = std::max(1, bar.frames / std::max(1, static_cast<int>(bar.width())));
  int from = -1;
  for (int i = 0; i <= bar.frames; i += step) {
    const bool in = i < bar.frames && state.cached(i);
    if (in && from < 0) from = i;
    if (!in && from >= 0) {
      list.AddRectFilled({bar.left(from), bar.end.y - ui.px(3)}, {bar.left(i), bar.end.y}, ui_color::kGood);
      from = -1;
    }
  }
  if (from >= 0) list.AddRectFilled({bar.left(from), bar.end.y - ui.px(3)}, bar.end, ui_color::kGood);
}

void draw_scrub_bar(const Ui& ui, TransportBarState& state) {
  Transport& transport = state.transport;
  const float height = ui.px(22);
  const ImVec2 begin = ImGui::GetCursorScreenPos();
  ImGui::InvisibleButton("scrub", {std::max(ImGui::GetContentRegionAvail().x, 1.0f), height},
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
  const Bar bar{begin, ImGui::GetItemRectMax(), transport.frames()};
  const int under = position_in_bar(ImGui::GetIO().MousePos.x, begin.x, bar.width(), bar.frames);
  if (ImGui::IsItemActive() && ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
    // Shift sets the range, from the nearer end.
    if (!ImGui::GetIO().KeyShift)
      transport.go_to(under, state.now);
    else if (std::abs(under - transport.first()) < std::abs(under - transport.last()))
      transport.set_range(under, transport.last(), state.now);
    else
      transport.set_range(transport.first(), under, state.now);
  }
  if (ImGui::IsItemClicked(ImGuiMouseButton_Right)) transport.clear_range(state.now);
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("frame %d\nShift+drag: range (I, O); right-click: all of it (P)", state.number(under));

  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(bar.begin, bar.end, ImGui::GetColorU32(ImGuiCol_FrameBg), ui.px(3));
  list.AddRectFilled({bar.left(transport.first()), bar.begin.y}, {bar.left(transport.last() + 1), bar.end.y},
                     ImGui::GetColorU32(ImGuiCol_FrameBgActive), ui.px(3));
  draw_cached(list, ui, bar, state);
  const int at = state.shown >= 0 ? state.shown : transport.position();
  const float left = bar.left(at), right = std::max(bar.left(at + 1), left + ui.px(2));
  list.AddRectFilled({left, bar.begin.y}, {right, bar.end.y}, ui_color::kAccent, ui.px(1));
}

}  // namespace

int position_in_bar(float x, float left, float width, int frames) {
  if (!(width > 0) || frames <= 1) return 0;
  const double place = std::floor(static_cast<double>(x - left) / width * frames);
  return static_cast<int>(std::clamp(place, 0.0, static_cast<double>(frames - 1)));
}

float transport_bar_height(const Ui& ui) {
  return ui.px(22) + ImGui::GetFrameHeight() + ImGui::GetStyle().ItemSpacing.y + 2 * ImGui::GetStyle().WindowPadding.y;
}

void draw_transport_bar(Ui& ui, TransportBarState& state, ImVec2 place, ImVec2 size) {
  ImGui::SetNextWindowPos(place);
  ImGui::SetNextWindowSize(size);
  constexpr int kFlags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                         ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoSavedSettings |
                         ImGuiWindowFlags_NoBringToFrontOnFocus;
  if (ImGui::Begin("Transport", nullptr, kFlags)) {
    draw_scrub_bar(ui, state);
    draw_buttons(ui, state);
    draw_figures(ui, state);
  }
  ImGui::End();
}

}  // namespace afterglow
