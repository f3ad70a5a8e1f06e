// SPDX-License-Identifier: MIT
// Dark sheets over the picture, for overlay.cpp and figures_overlay.cpp.
#pragma once

#include <imgui.h>

#include <string>

#include "window/ui.h"

namespace afterglow {

/// `pivot` is the corner of the sheet (0 or 1 in each direction) that lies at `at`.
void begin_sheet(const char* name, ImVec2 at, ImVec2 pivot, const Ui& ui, ImGuiWindowFlags more);
void end_sheet();
void colored(ImU32 color, const std::string& text);

}  // namespace afterglow
