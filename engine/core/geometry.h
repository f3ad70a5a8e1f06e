// SPDX-License-Identifier: MIT
// Integer sizes and rectangles. Pixel (x, y) covers [x, x+1) × [y, y+1); y grows downwards.
#pragma once

namespace afterglow {

struct Size {
  int width = 0, height = 0;
  friend bool operator==(const Size&, const Size&) = default;
  long long area() const { return static_cast<long long>(width) * height; }
};

struct Rect {
  int x = 0, y = 0, width = 0, height = 0;
  friend bool operator==(const Rect&, const Rect&) = default;
  Size size() const { return {width, height}; }
};

}  // namespace afterglow
