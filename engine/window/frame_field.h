// SPDX-License-Identifier: MIT
// The field that a frame is gone to by: its number, or a timecode.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "window/ui.h"

namespace afterglow {

/// The position that a text names: the frame of that number, else the next one that is there; "+12", "-3": from the
/// present one; hours:minutes:seconds:frames (or fewer parts, from the right) counts from the first frame. None: the
/// text is none of these. `number` tells the frame at a position, ascending as far as it can be.
std::optional<int> position_named(const std::string& text, int position, int frames, double fps,
                                  const std::function<int(int)>& number);
/// "00:00:04:11" of a position.
std::string timecode_text(int position, double fps);

/// Within a frame of ImGui, over the picture. The text, once it was entered; empty when it was given up. Closes itself
/// (Ui::show_frame_field) then.
std::optional<std::string> draw_frame_field(Ui& ui, ImVec2 middle);

}  // namespace afterglow
