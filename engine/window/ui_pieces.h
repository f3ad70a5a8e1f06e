// SPDX-License-Identifier: MIT
// The triangles of an interface, and which of them parts of a window need.
#pragma once

#include <imgui.h>

#include <cstdint>
#include <span>
#include <vector>

#include "window/window_tiles.h"

namespace afterglow {

/// One indexed draw of a part of the window.
struct UiDraw {
  Rect scissor;
  std::uint32_t first_index = 0, count = 0;  ///< of the indices that were written for it
  std::int32_t vertex_offset = 0;            ///< in the vertices of all lists, one behind the other
};

/// Drawing thread alone. Keeps pointers into ImGui's data until the next `take`.
class UiPieces {
 public:
  /// The whole atlas is another one.
  void take_atlas(Size atlas);
  /// Takes apart what ImGui wants drawn onto a target. `written`: parts of the atlas with other pixels than in the
  /// frame before.
  void take(const ImDrawData& data, Size target, std::span<const Rect> written);
  void add_to(WindowTiles& tiles) const;
  /// What has to be drawn within `only` (which have no pixel in common): draws in the order in which ImGui wants them
  /// for each pixel, and their indices. Draws that were there before are gone.
  void write(std::span<const Rect> only, std::vector<UiDraw>& draws, std::vector<ImDrawIdx>& indices) const;

 private:
  /// Triangles that lie next to each other: one, or the two of a rectangle, which drivers may draw as one.
  struct Piece {
    Rect pixels;  ///< that it may reach
    std::uint64_t what = 0;
    const ImDrawIdx* indices = nullptr;
    std::uint32_t count = 0;
  };
  struct Command {
    Rect scissor;
    std::int32_t vertex_offset = 0;
    std::size_t first = 0, end = 0;  ///< of the pieces
  };
  struct Written {
    Rect part;
    std::uint64_t serial = 0;
  };
  void take_command(const ImDrawList& list, const ImDrawCmd& command, std::int32_t vertex_offset, const Rect& scissor);
  Piece piece(const ImDrawVert* vertices, const ImDrawIdx* indices, std::uint32_t count, const Rect& scissor) const;
  std::uint64_t atlas_serial(ImVec2 from, ImVec2 to) const;

  std::vector<Piece> pieces_;
  std::vector<Command> commands_;
  Size atlas_;
  std::vector<Written> written_;
  std::uint64_t serial_ = 0;
  ImVec2 scale_, shift_;
};

}  // namespace afterglow
