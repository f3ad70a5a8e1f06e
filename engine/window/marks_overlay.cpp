// SPDX-License-Identifier: MIT
// Marks over the picture: the pixel whose values are told; that another frame is shown than the one that is asked for.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "window/overlay.h"
#include "window/sheet.h"

namespace afterglow {
namespace {

ImVec2 on_screen(const OverlayPicture& place, Point at) {
  const Point p = to_screen(place.place, at);
  return {static_cast<float>(p.x + place.right) * place.pixel.x, static_cast<float>(p.y) * place.pixel.y};
}

/// Light within dark: it shows on any picture.
void frame(ImDrawList& list, ImVec2 from, ImVec2 to, float line) {
  list.AddRect({from.x - 2 * line, from.y - 2 * line}, {to.x + 2 * line, to.y + 2 * line}, IM_COL32(0, 0, 0, 255), 0, 0,
               line);
  list.AddRect({from.x - line, from.y - line}, {to.x + line, to.y + line}, IM_COL32(255, 255, 255, 255), 0, 0, line);
}

}  // namespace

void draw_pixel_mark(Pixel pixel, const Ui& ui, const OverlayPicture& place) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const ImVec2 from = on_screen(place, {static_cast<double>(pixel.x), static_cast<double>(pixel.y)});
  const ImVec2 to = on_screen(place, {pixel.x + 1.0, pixel.y + 1.0});
  // Smaller ones are shown by what stands around them.
  const float least = ui.px(5), spare = std::max(0.0f, (least - (to.x - from.x)) / 2);
  frame(list, {from.x - spare, from.y - spare}, {to.x + spare, to.y + spare}, ui.px(1));
}

std::string frame_mark_text(const ShownFrame& shown, bool picture) {
  if (!shown.unreadable) return fmt::format("Frame {} is missing; {} is shown", shown.number, shown.name);
  return fmt::format("Frame {} cannot be read{}", shown.number, picture ? "; an earlier picture is shown" : "");
}

void draw_frame_mark(const Player& player, const Ui& ui, const OverlayPicture& place, const OverlayArea& area) {
  const ShownFrame& shown = player.shown();
  if (!shown.held && !shown.unreadable) return;
  const ImU32 color = shown.unreadable ? ui_color::kError : ui_color::kWarning;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  ImVec2 from = on_screen(place, {0, 0});
  ImVec2 to = on_screen(place, {static_cast<double>(place.picture.width), static_cast<double>(place.picture.height)});
  const float line = ui.px(3);
  from = {std::max(from.x, area.at.x) + line / 2, std::max(from.y, area.at.y) + line / 2};
  to = {std::min(to.x, area.at.x + area.size.x) - line / 2, std::min(to.y, area.at.y + area.size.y) - line / 2};
  if (place.picture.area() > 0) list.AddRect(from, to, color, 0, 0, line);
  const std::string text = frame_mark_text(shown, place.picture.area() > 0);
  begin_sheet("frame", {area.at.x + area.size.x / 2, area.at.y + ui.px(14)}, {0.5f, 0}, ui, ImGuiWindowFlags_NoInputs);
  ImGui::PushTextWrapPos(sheet_wrap(ui, area.size.x));
  colored(color, text);
  ImGui::PopTextWrapPos();
  end_sheet();
}

}  // namespace afterglow
