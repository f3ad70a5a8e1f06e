// SPDX-License-Identifier: MIT
#include "window/window_tiles.h"

#include <algorithm>

namespace afterglow {

namespace {

/// Each rectangle costs some draws: a tile between two that have changed is drawn along.
constexpr int kClosedGap = 2;

constexpr int tiles_of(int pixels) { return (pixels + WindowTiles::kSide - 1) / WindowTiles::kSide; }

/// From one tile of a row to another, which is not of it.
struct Run {
  int from = 0, to = 0;
  friend bool operator==(const Run&, const Run&) = default;
};

std::vector<Run> runs_of(std::span<const std::uint64_t> now, std::span<const std::uint64_t> before) {
  std::vector<Run> out;
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (now[i] == before[i]) continue;
    const int at = static_cast<int>(i);
    if (!out.empty() && at - out.back().to < kClosedGap) {
      out.back().to = at + 1;
    } else {
      out.push_back({at, at + 1});
    }
  }
  return out;
}

}  // namespace

Rect common_part(const Rect& a, const Rect& b) {
  const int x = std::max(a.x, b.x), y = std::max(a.y, b.y);
  return {x, y, std::max(std::min(a.x + a.width, b.x + b.width) - x, 0),
          std::max(std::min(a.y + a.height, b.y + b.height) - y, 0)};
}

std::array<Rect, 4> parts_beside(const Rect& all, const Rect& hole) {
  if (hole.size().area() == 0) return {all};
  const int right = hole.x + hole.width, bottom = hole.y + hole.height;
  return {Rect{all.x, all.y, all.width, hole.y - all.y},
          {all.x, bottom, all.width, all.y + all.height - bottom},
          {all.x, hole.y, hole.x - all.x, hole.height},
          {right, hole.y, all.x + all.width - right, hole.height}};
}

/// MurmurHash3's last step, over a sum in which the order counts.
std::uint64_t mixed(std::uint64_t a, std::uint64_t b) {
  std::uint64_t h = a * 0x9e3779b97f4a7c15 + b;
  h = (h ^ (h >> 33)) * 0xff51afd7ed558ccd;
  h = (h ^ (h >> 33)) * 0xc4ceb9fe1a85ec53;
  return h ^ (h >> 33);
}

void WindowTiles::begin(Size window, std::uint64_t all) {
  window_ = window;
  count_ = {tiles_of(window.width), tiles_of(window.height)};
  numbers_.assign(static_cast<std::size_t>(count_.area()), all);
}

void WindowTiles::add(const Rect& pixels, std::uint64_t what) {
  const Rect in = common_part(pixels, {0, 0, window_.width, window_.height});
  if (in.size().area() == 0) return;
  const int right = tiles_of(in.x + in.width), bottom = tiles_of(in.y + in.height);
  for (int y = in.y / kSide; y < bottom; ++y) {
    std::uint64_t* row = &numbers_[static_cast<std::size_t>(y) * static_cast<std::size_t>(count_.width)];
    for (int x = in.x / kSide; x < right; ++x) row[x] = mixed(row[x], what);
  }
}

std::vector<Rect> WindowTiles::changed(std::span<const std::uint64_t> before) const {
  const Rect window{0, 0, window_.width, window_.height};
  if (before.size() != numbers_.size()) return {window};
  const auto width = static_cast<std::size_t>(count_.width);
  std::vector<Rect> out;
  std::vector<std::size_t> open;  // those of `out` that end where the row begins
  for (int y = 0; y < count_.height; ++y) {
    const std::size_t first = static_cast<std::size_t>(y) * width;
    std::vector<std::size_t> here;
    for (const Run& run : runs_of(std::span(numbers_).subspan(first, width), before.subspan(first, width))) {
      const auto above = std::ranges::find_if(open, [&](std::size_t i) {
        return out[i].x == run.from * kSide && out[i].width == (run.to - run.from) * kSide;
      });
      if (above != open.end()) {
        out[*above].height += kSide;
        here.push_back(*above);
      } else {
        here.push_back(out.size());
        out.push_back({run.from * kSide, y * kSide, (run.to - run.from) * kSide, kSide});
      }
    }
    open = std::move(here);
  }
  for (Rect& rect : out) rect = common_part(rect, window);
  return out;
}

}  // namespace afterglow
