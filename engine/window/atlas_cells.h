// SPDX-License-Identifier: MIT
// Small pictures that the interface draws itself (scopes, thumbnails): cells of the atlas that has the glyphs.
#pragma once

#include <imgui.h>

#include <array>
#include <span>
#include <vector>

#include "core/geometry.h"

namespace afterglow {

/// Drawing thread alone.
class AtlasCells {
 public:
  /// The first cells are scopes', the others thumbnails': of a list, and two beside each other.
  static constexpr int kScopes = 4, kThumbnails = 16, kPair = 2;
  static constexpr int kCells = kScopes + kThumbnails + kPair;
  static constexpr int kSide = 256;                                   ///< of a scope's cell, in pixels
  static constexpr int kThumbnailWidth = 128, kThumbnailHeight = 72;  ///< of a thumbnail's

  /// Before the atlas is built, each time.
  void reserve(ImFontAtlas& atlas);
  /// `pixels`: all of the cell, row by row from the top. Shown from the next frame on. The atlas has been built.
  void write(int cell, std::span<const ImU32> pixels);
  /// `to` and `from` are corners on the screen.
  void draw(ImDrawList& list, int cell, ImVec2 from, ImVec2 to) const;
  /// Of the atlas, what has been written since the last call.
  std::vector<Rect> take_written();
  /// Grows with each `reserve`: what was written before is gone.
  int generation() const { return generation_; }

 private:
  Rect place(int cell) const;
  std::array<int, kCells> ids_{};
  std::array<bool, kCells> written_{};
  int generation_ = 0;
};

}  // namespace afterglow
