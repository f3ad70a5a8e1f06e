// SPDX-License-Identifier: MIT
// A cell of the atlas that shows one thumbnail after the other.
#pragma once

#include <memory>

#include "window/thumbnails.h"
#include "window/ui.h"

namespace afterglow {

/// Drawing thread alone.
class ThumbnailCell {
 public:
  /// `thumbnail`, between two corners of the screen; null: it is still to come. Nothing but a frame for one that has an
  /// error. `cell`: see AtlasCells, always the same one.
  void draw(Ui& ui, int cell, const std::shared_ptr<const Thumbnail>& thumbnail, ImVec2 from, ImVec2 to);

 private:
  std::shared_ptr<const Thumbnail> shown_;
  int generation_ = -1;  ///< of the atlas
};

}  // namespace afterglow
