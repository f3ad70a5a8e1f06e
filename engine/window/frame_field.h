// SPDX-License-Identifier: MIT
// The field that a frame is gone to by: its number, or a timecode.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "window/ui.h"

namespace afterglow {

/// Where the frames are that a text may name.
struct FrameRow {
  int position = 0, frames = 0;         ///< that is shown; of all clips
  int clip_first = 0, clip_frames = 0;  ///< of the clip that is shown
  double fps = 24;
  std::function<int(int)> number = {};  ///< of the frame at a position; they rise within a clip
};

/// The position that a text names: the frame of that number in the clip that is shown, else in the first one that has
/// it, else the next one of the clip; "+12", "-3": from the present one; hours:minutes:seconds:frames (or fewer parts,
/// from the right) counts from the first frame. None: the text is none of these.
std::optional<int> position_named(const std::string& text, const FrameRow& row);
/// "00:00:04:11" of a position.
std::string timecode_text(int position, double fps);

/// Within a frame of ImGui, over the picture. The text, once it was entered; empty when it was given up. Closes itself
/// (Ui::show_frame_field) then.
std::optional<std::string> draw_frame_field(Ui& ui, ImVec2 middle);

}  // namespace afterglow
