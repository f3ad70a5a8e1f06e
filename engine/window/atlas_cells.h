// SPDX-License-Identifier: MIT
// Small pictures that the interface draws itself (scopes): cells of the atlas that has the glyphs.
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
  static constexpr int kCells = 4, kSide = 256;  // pixels

  /// Before the atlas is built, each time.
  void reserve(ImFontAtlas& atlas);
  /// `pixels`: kSide rows of kSide, from the top. Shown from the next frame on. The atlas has been built.
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
