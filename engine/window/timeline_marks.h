// SPDX-License-Identifier: MIT
// What stands over and on the bar of a timeline: numbers of frames, borders of clips, markers.
#pragma once

#include <string>

#include "window/timeline.h"

namespace afterglow {

float ruler_height(const Ui& ui);
void draw_ruler(ImDrawList& list, const Ui& ui, const TimelineState& state, ImVec2 place, float width);
/// A line where each clip but the first begins, and names where there is room. Nothing for one clip.
void draw_clips(ImDrawList& list, const Ui& ui, const TimelineState& state, ImVec2 begin, ImVec2 end);
void draw_markers(ImDrawList& list, const Ui& ui, const TimelineState& state, ImVec2 begin, ImVec2 end);
/// What is told of the frame under the pointer: its number, its clip of several, the nearest marker in reach.
std::string hint_of(const Ui& ui, const TimelineState& state, float width, int under);

}  // namespace afterglow
