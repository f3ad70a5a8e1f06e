// SPDX-License-Identifier: MIT
#include "window/transport_bar.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "window/flow.h"
#include "window/frame_field.h"
#include "window/icons.h"

namespace afterglow {
namespace {

/// From left to right. What does not fit goes to the next row, whole.
enum Piece { kFirst, kBack, kPlay, kOn, kLast, kLoop, kSpeed, kRate, kEvery, kZoom, kFilter, kCounter, kPace, kPieces };

/// In front of a piece.
float gap(const Ui& ui, int piece) { return ui.px(piece > kFirst && piece <= kLast ? 2 : 8); }

/// Of figures that keep their width while their digits change.
float mono_width(const Ui& ui, int characters) {
  ImGui::PushFont(ui.mono);
  const float one = ImGui::CalcTextSize("0").x;
  ImGui::PopFont();
  return one * static_cast<float>(characters);
}

std::array<float, kPieces> widths_of(const Ui& ui) {
  const ImGuiStyle& style = ImGui::GetStyle();
  const float frame = 2 * style.FramePadding.x;
  const auto text = [&](const char* longest) { return ImGui::CalcTextSize(longest).x + frame; };
  std::array<float, kPieces> widths{};
  for (int button = kFirst; button <= kLast; ++button) widths[static_cast<std::size_t>(button)] = icon_button_width(ui);
  widths[kLoop] = text("ping-pong");
  widths[kSpeed] = text("-8.00x");
  widths[kRate] = text("23.976 fps");
  widths[kEvery] = ImGui::GetFrameHeight() + style.ItemInnerSpacing.x + ImGui::CalcTextSize("every frame").x;
  widths[kZoom] = text("fit 1600%");
  widths[kFilter] = text("nearest");
  widths[kCounter] = mono_width(ui, 19);
  widths[kPace] = mono_width(ui, 20);
  return widths;
}

void draw_button(const Ui& ui, Transport& transport, double now, int piece) {
  switch (piece) {
    case kFirst:
      if (icon_button(ui, "##first", Icon::first, "To the first frame of the range (Home)")) transport.go_to_first(now);
      return;
    case kBack:
      if (icon_button(ui, "##back", Icon::back, "One frame back (Left)")) transport.step(-1, now);
      return;
    case kPlay:
      if (icon_button(ui, "##play", transport.playing() ? Icon::pause : Icon::play, "Play or pause (Space)"))
        transport.toggle(now);
      return;
    case kOn:
      if (icon_button(ui, "##on", Icon::on, "One frame on (Right)")) transport.step(1, now);
      return;
    default:
      if (icon_button(ui, "##last", Icon::last, "To the last frame of the range (End)")) transport.go_to_last(now);
  }
}

void draw_speed(const Ui& ui, Transport& transport, double now) {
  float speed = static_cast<float>(transport.speed());
  if (ImGui::DragFloat("##speed", &speed, 0.02f, -8, 8, "%.2fx") && std::abs(speed) >= Transport::kSlowest)
    transport.set_speed(speed, now);
  if (wants_menu(ui)) transport.set_speed(1, now);
  ui.help("Speed; negative is backwards (, and .); right-click for 1");
}

void draw_rate(const Ui& ui, Transport& transport, double now) {
  float fps = static_cast<float>(transport.fps());
  if (ImGui::DragFloat("##fps", &fps, 0.1f, 1, 240, "%.5g fps", ImGuiSliderFlags_AlwaysClamp))
    transport.set_fps(fps, now);
  ui.help("Frames a second at speed 1");
}

void draw_zoom(const Ui& ui, TransportBarState& state, float width) {
  View& view = state.view;
  const double zoom = view.fit ? fitting_zoom(state.picture, state.window) : view.zoom;
  const double percent = zoom * 100;
  const std::string figure = percent < 9.95 ? fmt::format("{:.1f}", percent) : fmt::format("{:.0f}", percent);
  if (ImGui::Button(fmt::format("{}{}%###zoom", view.fit ? "fit " : "", figure).c_str(), {width, 0})) {
    if (view.fit) {
      one_to_one(view, state.picture, state.window);
    } else {
      fit(view);
    }
  }
  ui.help("Zoom; between the whole picture (F) and one pixel for one pixel (1)");
}

void draw_counter(const Ui& ui, const TransportBarState& state) {
  const TimelineState& line = state.timeline;
  const int frames = line.transport.frames();
  ImGui::PushFont(ui.mono);
  ImGui::TextUnformatted((line.shown >= 0 ? fmt::format("{}  {}/{}", line.number(line.shown), line.shown + 1, frames)
                                          : fmt::format("-/{}", frames))
                             .c_str());
  ImGui::PopFont();
  ui.help(line.shown >= 0 ? fmt::format("{}\n{}", state.name, timecode_text(line.shown, line.transport.fps()))
                          : state.name);
}

void draw_pace(const Ui& ui, const TransportBarState& state) {
  const Transport& transport = state.timeline.transport;
  std::string text = transport.playing() ? fmt::format("{:.1f} fps", state.fps) : "";
  if (transport.dropped() > 0) text += fmt::format("{}{} dropped", text.empty() ? "" : "  ", transport.dropped());
  ImGui::PushFont(ui.mono);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopFont();
  ui.help(fmt::format("{} frames were not shown in time, {} of them because they had not been read",
                      transport.dropped(), state.late));
}

void draw_piece(const Ui& ui, TransportBarState& state, int piece, float width) {
  Transport& transport = state.timeline.transport;
  const double now = state.timeline.now;
  ImGui::SetNextItemWidth(width);
  switch (piece) {
    case kFirst:
    case kBack:
    case kPlay:
    case kOn:
    case kLast:
      return draw_button(ui, transport, now, piece);
    case kLoop:
      if (ImGui::Button(fmt::format("{}###loop", loop_mode_name(transport.loop())).c_str(), {width, 0}))
        transport.set_loop(static_cast<LoopMode>((static_cast<int>(transport.loop()) + 1) % 3), now);
      return ui.help("What happens at the ends of the range (Shift+L)");
    case kSpeed:
      return draw_speed(ui, transport, now);
    case kRate:
      return draw_rate(ui, transport, now);
    case kEvery: {
      bool every = transport.pacing() == Pacing::every_frame;
      if (ImGui::Checkbox("every frame", &every))
        transport.set_pacing(every ? Pacing::every_frame : Pacing::real_time, now);
      return ui.help("As fast as it goes, without dropping frames, instead of by the clock");
    }
    case kZoom:
      return draw_zoom(ui, state, width);
    case kFilter:
      if (ImGui::Button(state.view.smooth ? "linear###filter" : "nearest###filter", {width, 0}))
        state.view.smooth = !state.view.smooth;
      return ui.help(
          "Between pixels of a picture that is magnified: the nearest, or a linear way from one to the next (M)");
    case kCounter:
      return draw_counter(ui, state);
    default:
      return draw_pace(ui, state);
  }
}

std::vector<int> rows_for(const std::array<float, kPieces>& widths, const Ui& ui, float width) {
  std::array<float, kPieces> gaps{};
  for (int piece = 0; piece < kPieces; ++piece) gaps[static_cast<std::size_t>(piece)] = gap(ui, piece);
  return rows_of(widths, gaps, width - 2 * ImGui::GetStyle().WindowPadding.x);
}

}  // namespace

BarShape transport_bar_shape(const Ui& ui, float width) {
  const ImGuiStyle& style = ImGui::GetStyle();
  const int rows = rows_for(widths_of(ui), ui, width).back() + 1;
  return {rows, timeline_height(ui) + static_cast<float>(rows) * (ImGui::GetFrameHeight() + style.ItemSpacing.y) +
                    2 * style.WindowPadding.y};
}

void draw_transport_bar(Ui& ui, TransportBarState& state, ImVec2 place, ImVec2 size) {
  ImGui::SetNextWindowPos(place);
  ImGui::SetNextWindowSize(size);
  constexpr int kFlags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                         ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoSavedSettings |
                         ImGuiWindowFlags_NoBringToFrontOnFocus;
  if (ImGui::Begin("Transport", nullptr, kFlags)) {
    draw_timeline(ui, state.timeline);
    const auto widths = widths_of(ui);
    const auto rows = rows_for(widths, ui, size.x);
    float x = ImGui::GetCursorPosX();
    const float left = x;
    float y = ImGui::GetCursorPosY();
    for (int piece = 0; piece < kPieces; ++piece) {
      const auto i = static_cast<std::size_t>(piece);
      if (piece > 0 && rows[i] != rows[i - 1]) {
        x = left;
        y += ImGui::GetFrameHeight() + ImGui::GetStyle().ItemSpacing.y;
      }
      if (x > left) x += gap(ui, piece);
      ImGui::SetCursorPos({x, y});
      if (piece >= kCounter) ImGui::AlignTextToFramePadding();
      draw_piece(ui, state, piece, widths[i]);
      x += widths[i];
    }
  }
  ImGui::End();
}

}  // namespace afterglow
