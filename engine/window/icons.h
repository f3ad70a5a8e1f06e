// SPDX-License-Identifier: MIT
// Buttons with the signs of players, drawn: no font is sure to have them.
#pragma once

#include <imgui.h>

#include "window/ui.h"

namespace afterglow {

enum class Icon { first, back, pause, play, on, last };

/// True when pressed. `id`: of the button, for ImGui. `lit`: it is on.
bool icon_button(const Ui& ui, const char* id, Icon icon, const std::string& help, bool lit = false);
float icon_button_width(const Ui& ui);

}  // namespace afterglow
