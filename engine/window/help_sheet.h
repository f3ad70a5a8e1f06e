// SPDX-License-Identifier: MIT
// Every key and what it does, from the list that the keys themselves go by.
#pragma once

#include "window/ui.h"

namespace afterglow {

/// Over everything else, in the middle of an area of this size; draws nothing unless `ui.show_help`.
void draw_help_sheet(Ui& ui, ImVec2 area);

}  // namespace afterglow
