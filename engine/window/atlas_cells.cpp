// SPDX-License-Identifier: MIT
#include "window/atlas_cells.h"

#include <cstring>

namespace afterglow {

void AtlasCells::reserve(ImFontAtlas& atlas) {
  for (int cell = 0; cell < kCells; ++cell)
    ids_[static_cast<std::size_t>(cell)] = cell < kScopes
                                               ? atlas.AddCustomRectRegular(kSide, kSide)
                                               : atlas.AddCustomRectRegular(kThumbnailWidth, kThumbnailHeight);
  written_.fill(false);
  ++generation_;
}

Rect AtlasCells::place(int cell) const {
  const ImFontAtlasCustomRect* rect = ImGui::GetIO().Fonts->GetCustomRectByIndex(ids_[static_cast<std::size_t>(cell)]);
  return rect->IsPacked() ? Rect{rect->X, rect->Y, rect->Width, rect->Height} : Rect{};
}

void AtlasCells::write(int cell, std::span<const ImU32> pixels) {
  unsigned char* atlas = nullptr;
  int width = 0, height = 0;
  ImGui::GetIO().Fonts->GetTexDataAsRGBA32(&atlas, &width, &height);
  const Rect to = place(cell);
  const auto row = static_cast<std::size_t>(to.width);
  if (!atlas || to.size().area() == 0 || pixels.size() < row * static_cast<std::size_t>(to.height)) return;
  for (int y = 0; y < to.height; ++y) {
    const auto first =
        static_cast<std::size_t>(to.y + y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(to.x);
    std::memcpy(atlas + first * sizeof(ImU32), &pixels[static_cast<std::size_t>(y) * row], row * sizeof(ImU32));
  }
  written_[static_cast<std::size_t>(cell)] = true;
}

void AtlasCells::draw(ImDrawList& list, int cell, ImVec2 from, ImVec2 to) const {
  const ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  const Rect at = place(cell);
  // From the middle of the outermost pixels: their neighbours are glyphs.
  const auto uv = [&](float x, float y) {
    return ImVec2(x / static_cast<float>(atlas.TexWidth), y / static_cast<float>(atlas.TexHeight));
  };
  const auto x = static_cast<float>(at.x), y = static_cast<float>(at.y);
  list.AddImage(atlas.TexID, from, to, uv(x + 0.5f, y + 0.5f),
                uv(x + static_cast<float>(at.width) - 0.5f, y + static_cast<float>(at.height) - 0.5f));
}

std::vector<Rect> AtlasCells::take_written() {
  std::vector<Rect> out;
  for (int cell = 0; cell < kCells; ++cell)
    if (written_[static_cast<std::size_t>(cell)]) out.push_back(place(cell));
  written_.fill(false);
  return out;
}

}  // namespace afterglow
