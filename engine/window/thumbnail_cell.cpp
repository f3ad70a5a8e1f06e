// SPDX-License-Identifier: MIT
#include "window/thumbnail_cell.h"

namespace afterglow {

static_assert(Thumbnail::kWidth == AtlasCells::kThumbnailWidth && Thumbnail::kHeight == AtlasCells::kThumbnailHeight);

/// A cell is written when another thumbnail takes it, and with each new atlas.
void ThumbnailCell::draw(Ui& ui, int cell, const std::shared_ptr<const Thumbnail>& thumbnail, ImVec2 from, ImVec2 to) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(from, to, IM_COL32(10, 11, 12, 255));
  if (thumbnail && !thumbnail->error) {
    if (shown_ != thumbnail || generation_ != ui.cells.generation()) {
      ui.cells.write(cell, thumbnail->pixels);
      shown_ = thumbnail;
      generation_ = ui.cells.generation();
    }
    ui.cells.draw(list, cell, from, to);
  }
  list.AddRect(from, to, ui_color::kLine);
  if (!thumbnail) list.AddText({from.x + ui.px(8), from.y + ui.px(8)}, ui_color::kDim, "…");
}

}  // namespace afterglow
