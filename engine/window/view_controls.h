// SPDX-License-Identifier: MIT
// How the picture is looked at, as controls of the panel: which image, exposure, channels, marks, comparison.
#pragma once

#include "window/panel_port.h"
#include "window/ui.h"

namespace afterglow {

/// At the cursor of the present ImGui window.
void draw_view_controls(Ui& ui, PanelPort& port);

}  // namespace afterglow
