// SPDX-License-Identifier: MIT
// Asked before a window closes, or opens another preset, whose changes are not in the preset's file.
#pragma once

#include <optional>
#include <string>

#include "window/ui.h"

namespace afterglow {

enum class QuitAnswer { save, discard, cancel };

/// What is asked. `changes` and `exporting` are what would be lost, for people: "2 settings of look.lua", "frame 3 of
/// 12 to out.mp4"; empty: nothing.
struct QuitQuestion {
  std::string before;  ///< "closing"
  std::string changes, exporting;

  bool asks() const { return !changes.empty() || !exporting.empty(); }
};

/// Within a frame of ImGui, over everything. None: there is no answer yet. To save is to finish the export too.
std::optional<QuitAnswer> draw_quit_dialog(const Ui& ui, const QuitQuestion& question, ImVec2 area);
/// The same by a key (GLFW_KEY_…).
std::optional<QuitAnswer> quit_answer_of(int key);

}  // namespace afterglow
