// SPDX-License-Identifier: MIT
// Dark sheets over the picture, for overlay.cpp and figures_overlay.cpp.
#pragma once

#include <imgui.h>

#include <algorithm>
#include <string>

#include "window/ui.h"

namespace afterglow {

/// `pivot` is the corner of the sheet (0 or 1 in each direction) that is wanted at `at`; see SheetPlaces.
void begin_sheet(const char* name, ImVec2 at, ImVec2 pivot, const Ui& ui, ImGuiWindowFlags more);
void end_sheet();
/// Where words of a sheet go on in the next line, in a part of the window that is so wide.
inline float sheet_wrap(const Ui& ui, float width) { return std::clamp(width - ui.px(38), ui.px(60), ui.px(700)); }
void colored(ImU32 color, const std::string& text);

}  // namespace afterglow
