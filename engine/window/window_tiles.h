// SPDX-License-Identifier: MIT
// What a window shows, as a number for each of its tiles: where the number is the same, so are the pixels.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry.h"

namespace afterglow {

/// What two rectangles have in common; without area: nothing.
Rect common_part(const Rect& a, const Rect& b);

/// What of `all` lies above, below, left and right of `hole`, which lies in it.
std::array<Rect, 4> parts_beside(const Rect& all, const Rect& hole);

/// Two numbers become one; the order counts.
std::uint64_t mixed(std::uint64_t a, std::uint64_t b);

class WindowTiles {
 public:
  static constexpr int kSide = 16;  ///< of a tile, in pixels

  /// A frame of a window of that size, with nothing in it yet. `all`: what the whole of it depends on.
  void begin(Size window, std::uint64_t all);
  /// `what` is drawn onto these pixels, over all that was added before. Pixels beside the window do not count.
  void add(const Rect& pixels, std::uint64_t what);
  /// Of all tiles, row by row.
  const std::vector<std::uint64_t>& numbers() const { return numbers_; }
  /// Rectangles of whole tiles, cut off at the window's edges, that hold every tile whose number is another one than in
  /// `before`. They have no pixel in common. Numbers of a window of another size: all of it.
  std::vector<Rect> changed(std::span<const std::uint64_t> before) const;

 private:
  Size window_, count_;
  std::vector<std::uint64_t> numbers_;
};

}  // namespace afterglow
