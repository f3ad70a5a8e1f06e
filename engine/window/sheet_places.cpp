// SPDX-License-Identifier: MIT
#include "window/sheet_places.h"

#include <algorithm>

namespace afterglow {

namespace {

constexpr float kGap = 4;

}  // namespace

void SheetPlaces::follow_frame() const {
  if (frame_ == ImGui::GetFrameCount()) return;
  frame_ = ImGui::GetFrameCount();
  places_.clear();
}

ImVec2 SheetPlaces::place(ImVec2 at, ImVec2 pivot, ImVec2 size) {
  follow_frame();
  // Larger than its place: its title is what stays to be read.
  ImVec2 corner{std::max(at.x - pivot.x * size.x, 0.0f), at.y - pivot.y * size.y};
  const bool hangs = pivot.y == 0, stands = pivot.y == 1;
  const auto meets = [&](const Place& other) {
    return other.hangs == hangs && corner.x < other.to.x && other.from.x < corner.x + size.x && corner.y < other.to.y &&
           other.from.y < corner.y + size.y;
  };
  // Each way goes one way alone: it ends.
  for (auto other = places_.begin(); (hangs || stands) && other != places_.end();) {
    other = std::ranges::find_if(places_, meets);
    if (other != places_.end()) corner.y = hangs ? other->to.y + kGap : other->from.y - kGap - size.y;
  }
  corner.y = std::max(corner.y, 0.0f);
  if ((hangs || stands) && size.x > 0) places_.push_back({corner, {corner.x + size.x, corner.y + size.y}, hangs});
  return corner;
}

SheetPlaces::Room SheetPlaces::free(float left, float right, Room room) const {
  follow_frame();
  for (const Place& place : places_) {
    if (place.from.x >= right || left >= place.to.x) continue;
    if (place.hangs) {
      room.top = std::max(room.top, place.to.y + kGap);
    } else {
      room.bottom = std::min(room.bottom, place.from.y - kGap);
    }
  }
  return room;
}

}  // namespace afterglow
