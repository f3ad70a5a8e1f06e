// SPDX-License-Identifier: MIT
#include "window/ui_pieces.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace afterglow {

namespace {

struct Bounds {
  ImVec2 from{std::numeric_limits<float>::max(), std::numeric_limits<float>::max()};
  ImVec2 to{std::numeric_limits<float>::lowest(), std::numeric_limits<float>::lowest()};
  void add(ImVec2 at) {
    from = {std::min(from.x, at.x), std::min(from.y, at.y)};
    to = {std::max(to.x, at.x), std::max(to.y, at.y)};
  }
};

/// Of a target, what a clip rectangle of ImGui leaves.
Rect clipped_part(const ImVec4& clip, ImVec2 scale, ImVec2 shift, Size target) {
  const auto x0 = std::clamp((clip.x - shift.x) * scale.x, 0.0f, static_cast<float>(target.width));
  const auto y0 = std::clamp((clip.y - shift.y) * scale.y, 0.0f, static_cast<float>(target.height));
  const auto x1 = std::clamp((clip.z - shift.x) * scale.x, x0, static_cast<float>(target.width));
  const auto y1 = std::clamp((clip.w - shift.y) * scale.y, y0, static_cast<float>(target.height));
  return {static_cast<int>(x0), static_cast<int>(y0), static_cast<int>(x1 - x0), static_cast<int>(y1 - y0)};
}

std::uint64_t bits(ImVec2 v) {
  return std::uint64_t{std::bit_cast<std::uint32_t>(v.x)} << 32 | std::bit_cast<std::uint32_t>(v.y);
}

/// Of a draw. Mesa takes longer ones apart into 341 triangles each, through the middle of rectangles, and the two
/// halves of one round the places of texels in another way than the whole.
constexpr std::uint32_t kMostIndices = 1020;

/// As ImGui writes rectangles, glyphs and pictures: a b c, a c d.
bool is_rectangle(const ImDrawIdx* i) { return i[0] == i[3] && i[2] == i[4]; }

}  // namespace

void UiPieces::take_atlas(Size atlas) {
  atlas_ = atlas;
  written_.clear();
  ++serial_;
}

void UiPieces::take(const ImDrawData& data, Size target, std::span<const Rect> written) {
  if (!written.empty()) ++serial_;
  for (const Rect& part : written) {
    const auto known = std::ranges::find_if(written_, [&](const Written& w) { return w.part == part; });
    (known != written_.end() ? *known : written_.emplace_back(Written{part, 0})).serial = serial_;
  }
  pieces_.clear();
  commands_.clear();
  scale_ = data.FramebufferScale;
  shift_ = data.DisplayPos;
  std::int32_t first_vertex = 0;
  for (int i = 0; i < data.CmdListsCount; ++i) {
    const ImDrawList& list = *data.CmdLists[i];
    for (const ImDrawCmd& command : list.CmdBuffer) {
      if (command.UserCallback) continue;  // nobody here uses them
      const Rect scissor = clipped_part(command.ClipRect, scale_, shift_, target);
      if (scissor.size().area() == 0) continue;
      take_command(list, command, first_vertex + static_cast<std::int32_t>(command.VtxOffset), scissor);
    }
    first_vertex += list.VtxBuffer.Size;
  }
}

void UiPieces::take_command(const ImDrawList& list, const ImDrawCmd& command, std::int32_t vertex_offset,
                            const Rect& scissor) {
  Command out{.scissor = scissor, .vertex_offset = vertex_offset, .first = pieces_.size()};
  const ImDrawVert* vertices = list.VtxBuffer.Data + command.VtxOffset;
  const ImDrawIdx* indices = list.IdxBuffer.Data + command.IdxOffset;
  for (std::uint32_t left = command.ElemCount; left >= 3;) {
    const std::uint32_t count = left >= 6 && is_rectangle(indices) ? 6 : 3;
    const Piece made = piece(vertices, indices, count, scissor);
    if (made.pixels.size().area() > 0) pieces_.push_back(made);
    indices += count;
    left -= count;
  }
  out.end = pieces_.size();
  if (out.end > out.first) commands_.push_back(out);
}

UiPieces::Piece UiPieces::piece(const ImDrawVert* vertices, const ImDrawIdx* indices, std::uint32_t count,
                                const Rect& scissor) const {
  Bounds place, texels;
  std::uint64_t what = mixed(
      std::uint64_t{static_cast<std::uint32_t>(scissor.x)} << 32 | static_cast<std::uint32_t>(scissor.y),
      std::uint64_t{static_cast<std::uint32_t>(scissor.width)} << 32 | static_cast<std::uint32_t>(scissor.height));
  for (std::uint32_t i = 0; i < count; ++i) {
    if (i == 3 || i == 4) continue;  // a rectangle's vertices that were there already
    const ImDrawVert& vertex = vertices[indices[i]];
    place.add(vertex.pos);
    texels.add(vertex.uv);
    what = mixed(mixed(what, bits(vertex.pos)), bits(vertex.uv) * 0x9e3779b97f4a7c15 + vertex.col);
  }
  if (const std::uint64_t serial = atlas_serial(texels.from, texels.to)) what = mixed(what, serial);
  // What is far outside stays within whole numbers.
  const auto pixel = [](float at, float shift, float scale, int from, int size, auto round) {
    return static_cast<int>(
        round(std::clamp((at - shift) * scale, static_cast<float>(from), static_cast<float>(from + size))));
  };
  const auto down = [](float v) { return std::floor(v); };
  const auto up = [](float v) { return std::ceil(v); };
  const int x0 = pixel(place.from.x, shift_.x, scale_.x, scissor.x, scissor.width, down);
  const int y0 = pixel(place.from.y, shift_.y, scale_.y, scissor.y, scissor.height, down);
  const int x1 = pixel(place.to.x, shift_.x, scale_.x, scissor.x, scissor.width, up);
  const int y1 = pixel(place.to.y, shift_.y, scale_.y, scissor.y, scissor.height, up);
  return {{x0, y0, x1 - x0, y1 - y0}, what, indices, count};
}

/// When what a piece reads of the atlas was written.
std::uint64_t UiPieces::atlas_serial(ImVec2 from, ImVec2 to) const {
  const auto width = static_cast<float>(atlas_.width), height = static_cast<float>(atlas_.height);
  std::uint64_t latest = 0;
  for (const auto& [part, serial] : written_) {
    const auto left = static_cast<float>(part.x - 1), top = static_cast<float>(part.y - 1);
    const auto right = static_cast<float>(part.x + part.width + 1),
               bottom = static_cast<float>(part.y + part.height + 1);
    const bool reads = from.x * width < right && to.x * width > left && from.y * height < bottom && to.y * height > top;
    if (reads) latest = std::max(latest, serial);
  }
  return latest;
}

void UiPieces::add_to(WindowTiles& tiles) const {
  for (const Piece& piece : pieces_) tiles.add(piece.pixels, piece.what);
}

void UiPieces::write(std::span<const Rect> only, std::vector<UiDraw>& draws, std::vector<ImDrawIdx>& indices) const {
  draws.clear();
  indices.clear();
  for (const Rect& part : only) {
    bool fresh = true;  // no draw of this part that could be added to
    for (const Command& command : commands_) {
      const Rect scissor = common_part(command.scissor, part);
      if (scissor.size().area() == 0) continue;
      for (std::size_t i = command.first; i < command.end; ++i) {
        const Piece& piece = pieces_[i];
        if (common_part(piece.pixels, scissor).size().area() == 0) continue;
        if (fresh || draws.back().scissor != scissor || draws.back().vertex_offset != command.vertex_offset ||
            draws.back().count + piece.count > kMostIndices) {
          draws.push_back({scissor, static_cast<std::uint32_t>(indices.size()), 0, command.vertex_offset});
          fresh = false;
        }
        indices.insert(indices.end(), piece.indices, piece.indices + piece.count);
        draws.back().count += piece.count;
      }
    }
  }
}

}  // namespace afterglow
