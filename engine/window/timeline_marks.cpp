// SPDX-License-Identifier: MIT
#include "window/timeline_marks.h"

#include <fmt/format.h>

#include <cmath>

#include "window/timeline_ruler.h"

namespace afterglow {
namespace {

constexpr ImU32 kMarker = IM_COL32(110, 190, 255, 255), kBorder = IM_COL32(222, 224, 228, 150);
constexpr float kReach = 5;  // of the pointer around a marker

float label_size(const Ui& ui) { return ui.px(11); }

float text_width(const ImFont& font, float size, const std::string& text) {
  return font.CalcTextSizeA(size, 1e9f, 0, text.c_str()).x;
}

float middle_of(const TimelineState& state, float width, int position) {
  return width * (static_cast<float>(position) + 0.5f) / static_cast<float>(state.footage.frames());
}

}  // namespace

float ruler_height(const Ui& ui) { return ui.px(16); }

void draw_ruler(ImDrawList& list, const Ui& ui, const TimelineState& state, ImVec2 place, float width) {
  const float size = label_size(ui), bottom = place.y + ruler_height(ui) - ui.px(1);
  const RulerSpace space{
      .width = width, .gap = ui.px(10), .least_tick = ui.px(5), .width_of = [&](const std::string& text) {
        return text_width(*ui.mono, size, text);
      }};
  for (const RulerTick& tick : ruler_ticks(state.footage, space)) {
    const float x = place.x + tick.x;
    list.AddLine({x, bottom - ui.px(tick.label.empty() ? 2 : 4)}, {x, bottom}, ui_color::kDim, ui.px(1));
    if (!tick.label.empty())
      list.AddText(ui.mono, size, {place.x + tick.label_x, place.y - ui.px(1)}, ui_color::kDim, tick.label.c_str());
  }
}

void draw_clips(ImDrawList& list, const Ui& ui, const TimelineState& state, ImVec2 begin, ImVec2 end) {
  const auto& clips = state.footage.clips();
  if (clips.size() < 2) return;
  const float width = end.x - begin.x, size = label_size(ui), pad = ui.px(5);
  float drawn = begin.x;  // borders that lie closer than they are wide would be one bright block
  for (const auto& clip : clips) {
    const auto frames = static_cast<float>(state.footage.frames());
    const float left = begin.x + width * static_cast<float>(clip.first) / frames;
    const float right = begin.x + width * static_cast<float>(clip.first + clip.frames) / frames;
    if (clip.first > 0 && left - drawn >= ui.px(4)) {
      list.AddLine({left, begin.y}, {left, end.y}, kBorder, ui.px(2));
      drawn = left;
    }
    if (right - left >= text_width(*ui.body, size, clip.label) + 2 * pad)
      list.AddText(ui.body, size, {left + pad, begin.y + ui.px(4)}, ui_color::kText, clip.label.c_str());
  }
}

void draw_markers(ImDrawList& list, const Ui& ui, const TimelineState& state, ImVec2 begin, ImVec2 end) {
  for (const Marker& marker : state.markers.all()) {
    const float x = begin.x + middle_of(state, end.x - begin.x, marker.position), half = ui.px(4);
    list.AddLine({x, begin.y}, {x, end.y}, kMarker, ui.px(2));
    list.AddTriangleFilled({x - half, begin.y - ui.px(1)}, {x + half, begin.y - ui.px(1)}, {x, begin.y + ui.px(6)},
                           kMarker);
  }
}

std::string hint_of(const Ui& ui, const TimelineState& state, float width, int under) {
  std::string out = fmt::format("frame {}", state.number(under));
  const auto& clips = state.footage.clips();
  if (clips.size() > 1) out = clips[static_cast<std::size_t>(state.footage.clip_at(under))].label + ", " + out;
  const float at = middle_of(state, width, under);
  const Marker* nearest = nullptr;
  float nearest_by = ui.px(kReach);
  for (const Marker& marker : state.markers.all()) {
    const float by = marker.position == under ? 0 : std::abs(middle_of(state, width, marker.position) - at);
    if (by > nearest_by) continue;
    nearest = &marker;
    nearest_by = by;
  }
  if (!nearest) return out;
  if (nearest->position == under) return out + (nearest->name.empty() ? " (marked)" : ": " + nearest->name);
  return out + fmt::format(" (marker at {}{})", state.number(nearest->position),
                           nearest->name.empty() ? "" : ": " + nearest->name);
}

}  // namespace afterglow
