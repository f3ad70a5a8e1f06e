// SPDX-License-Identifier: MIT
#include "window/timeline.h"

#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>

#include "window/timeline_marks.h"

namespace afterglow {
namespace {

struct Bar {
  ImVec2 begin, end;
  int frames;
  float width() const { return end.x - begin.x; }
  float left(int position) const {
    return begin.x + width() * static_cast<float>(position) / static_cast<float>(frames);
  }
};

/// Missing: hollow, with a stroke from corner to corner. Unreadable: filled, with a cross.
void draw_run(ImDrawList& list, const Ui& ui, const Bar& bar, FrameState state, int from, int to) {
  const float left = bar.left(from), right = std::max(bar.left(to), left + ui.px(2)), line = ui.px(1.5f);
  const float top = bar.begin.y, bottom = bar.end.y;
  switch (state) {
    case FrameState::unread:
      break;
    case FrameState::cached:
      list.AddRectFilled({left, bottom - ui.px(3)}, {right, bottom}, ui_color::kGood);
      break;
    case FrameState::missing:
      list.AddRect({left, top + ui.px(3)}, {right, bottom - ui.px(3)}, ui_color::kWarning, 0, 0, line);
      list.AddLine({left, bottom - ui.px(4)}, {right, top + ui.px(4)}, ui_color::kWarning, line);
      break;
    case FrameState::unreadable:
      list.AddRectFilled({left, top + ui.px(3)}, {right, bottom - ui.px(3)}, IM_COL32(140, 44, 40, 255));
      list.AddLine({left, bottom - ui.px(4)}, {right, top + ui.px(4)}, ui_color::kError, line);
      list.AddLine({left, top + ui.px(4)}, {right, bottom - ui.px(4)}, ui_color::kError, line);
      break;
  }
}

/// One shape for frames of one kind that follow each other. Of those that share a pixel, the worst is drawn.
void draw_frames(ImDrawList& list, const Ui& ui, const Bar& bar, const TimelineState& state) {
  const int step = std::max(1, bar.frames / std::max(1, static_cast<int>(bar.width())));
  int from = 0;
  FrameState run = FrameState::unread;
  for (int i = 0; i < bar.frames; i += step) {
    FrameState worst = FrameState::unread;
    for (int j = i; j < std::min(i + step, bar.frames); ++j) worst = std::max(worst, state.state(j));
    if (worst == run) continue;
    draw_run(list, ui, bar, run, from, i);
    from = i;
    run = worst;
  }
  draw_run(list, ui, bar, run, from, bar.frames);
}

/// What lies beyond the range is dark; brackets stand at its ends.
void draw_range(ImDrawList& list, const Ui& ui, const Bar& bar, const Transport& transport) {
  list.AddRectFilled(bar.begin, bar.end, ImGui::GetColorU32(ImGuiCol_FrameBg), ui.px(3));
  if (transport.first() == 0 && transport.last() == bar.frames - 1) return;
  const float left = bar.left(transport.first()), right = bar.left(transport.last() + 1);
  const ImU32 dark = IM_COL32(14, 15, 17, 255), lit = IM_COL32(78, 84, 94, 255);
  list.AddRectFilled(bar.begin, {left, bar.end.y}, dark, ui.px(3), ImDrawFlags_RoundCornersLeft);
  list.AddRectFilled({right, bar.begin.y}, bar.end, dark, ui.px(3), ImDrawFlags_RoundCornersRight);
  list.AddRectFilled({left, bar.begin.y}, {right, bar.end.y}, lit);
  const float line = ui.px(2), foot = ui.px(6);
  const auto bracket = [&](float x, float inwards) {
    list.AddLine({x, bar.begin.y}, {x, bar.end.y}, ui_color::kText, line);
    list.AddLine({x, bar.begin.y + line / 2}, {x + inwards, bar.begin.y + line / 2}, ui_color::kText, line);
    list.AddLine({x, bar.end.y - line / 2}, {x + inwards, bar.end.y - line / 2}, ui_color::kText, line);
  };
  bracket(left + line / 2, foot);
  bracket(right - line / 2, -foot);
}

const char* words_of(FrameState state) {
  switch (state) {
    case FrameState::missing:
      return " is missing: the one before is shown";
    case FrameState::unreadable:
      return " cannot be read";
    default:
      return "";
  }
}

/// Above the bar, so that it covers nothing of it.
void draw_hint(const Ui& ui, const Bar& bar, const TimelineState& state, int under) {
  const float x = std::clamp(ImGui::GetIO().MousePos.x, bar.begin.x, bar.end.x);
  ImGui::SetNextWindowPos({x, bar.begin.y - ui.px(4)}, ImGuiCond_Always, {0.5f, 1});
  ImGui::SetTooltip("%s", (hint_of(ui, state, bar.width(), under) + words_of(state.state(under))).c_str());
}

void move(TimelineState& state, int under) {
  Transport& transport = state.transport;
  // Shift sets the range, from the nearer end.
  if (!ImGui::GetIO().KeyShift)
    transport.go_to(under, state.now);
  else if (std::abs(under - transport.first()) < std::abs(under - transport.last()))
    transport.set_range(under, transport.last(), state.now);
  else
    transport.set_range(transport.first(), under, state.now);
}

}  // namespace

int position_in_bar(float x, float left, float width, int frames) {
  if (!(width > 0) || frames <= 1) return 0;
  const double place = std::floor(static_cast<double>(x - left) / width * frames);
  return static_cast<int>(std::clamp(place, 0.0, static_cast<double>(frames - 1)));
}

float timeline_height(const Ui& ui) { return ui.px(24) + ruler_height(ui); }

void draw_timeline(const Ui& ui, TimelineState& state) {
  Transport& transport = state.transport;
  const ImVec2 begin = ImGui::GetCursorScreenPos();
  ImGui::PushItemFlag(ImGuiItemFlags_NoNav, true);  // keys that choose items have no use for it
  ImGui::InvisibleButton("scrub", {std::max(ImGui::GetContentRegionAvail().x, 1.0f), timeline_height(ui)},
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
  ImGui::PopItemFlag();
  const Bar bar{{begin.x, begin.y + ruler_height(ui)}, ImGui::GetItemRectMax(), transport.frames()};
  const int under = position_in_bar(ImGui::GetIO().MousePos.x, begin.x, bar.width(), bar.frames);
  if (ImGui::IsItemActive() && ImGui::IsMouseDown(ImGuiMouseButton_Left)) move(state, under);
  if (ImGui::IsItemClicked(ImGuiMouseButton_Right)) transport.clear_range(state.now);
  if (ImGui::IsItemHovered() || ImGui::IsItemActive()) draw_hint(ui, bar, state, under);

  ImDrawList& list = *ImGui::GetWindowDrawList();
  draw_range(list, ui, bar, transport);
  draw_frames(list, ui, bar, state);
  draw_ruler(list, ui, state, begin, bar.width());
  draw_clips(list, ui, state, bar.begin, bar.end);
  const int at = state.shown >= 0 ? state.shown : transport.position();
  const float left = bar.left(at), right = std::max(bar.left(at + 1), left + ui.px(2));
  list.AddRect({left, bar.begin.y}, {right, bar.end.y}, ui_color::kAccent, 0, 0, ui.px(2));
  const float width = std::min(right - left, ui.px(6)), middle = (left + right) / 2;
  list.AddRectFilled({middle - width / 2, bar.begin.y}, {middle + width / 2, bar.end.y}, ui_color::kAccent);
  draw_markers(list, ui, state, bar.begin, bar.end);  // last: one of the frame that is shown is seen too
}

}  // namespace afterglow
