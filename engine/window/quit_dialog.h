// SPDX-License-Identifier: MIT
// Asked before a window closes, or opens another preset, whose changes are not in the preset's file.
#pragma once

#include <optional>
#include <string>

#include "window/ui.h"

namespace afterglow {

enum class QuitAnswer { save, discard, cancel };

/// Within a frame of ImGui, over everything. `before`: "closing". None: there is no answer yet.
std::optional<QuitAnswer> draw_quit_dialog(const Ui& ui, const std::string& before, const std::string& changes,
                                           ImVec2 area);
/// The same by a key (GLFW_KEY_…).
std::optional<QuitAnswer> quit_answer_of(int key);

}  // namespace afterglow
