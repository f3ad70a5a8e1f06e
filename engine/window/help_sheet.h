// SPDX-License-Identifier: MIT
// Every key and what it does, from the list that the keys themselves go by.
#pragma once

#include <string>
#include <vector>

#include "window/ui.h"

namespace afterglow {

struct HelpGroup {
  const char* name = "";
  int lines = 0;  ///< that it takes, with its head and the space behind it
};
std::vector<HelpGroup> help_groups();

/// Groups in their order, parted into columns so that the longest is as short as it can be.
struct HelpLayout {
  std::vector<int> column;  ///< of each group
  int height = 0;           ///< of the longest column, in lines
};
HelpLayout help_layout(const std::vector<HelpGroup>& groups, int columns);

/// The same as a page of HTML, to print.
std::string keys_page();

/// Over everything else, in the middle of an area of this size; draws nothing unless `ui.show_help`.
void draw_help_sheet(Ui& ui, ImVec2 area);

}  // namespace afterglow
