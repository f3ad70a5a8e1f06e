// SPDX-License-Identifier: MIT
#include "image/orientation.h"

#include <cstring>
#include <utility>

namespace afterglow {
namespace {

// Exif: 1 normal, 2 mirrored left-right, 3 turned by 180°, 4 mirrored top-bottom, 5 transposed, 6 needs a quarter turn
// clockwise, 7 transposed about the other diagonal, 8 needs a quarter turn anti-clockwise. Seen from the upright
// picture, each is a choice of axis and of directions in the stored one.
struct Turn {
  bool swap, flip_x, flip_y;  // flips are of the stored x and y
};

Turn turn_of(int orientation) {
  switch (orientation) {
    case 2:
      return {false, true, false};
    case 3:
      return {false, true, true};
    case 4:
      return {false, false, true};
    case 5:
      return {true, false, false};
    case 6:
      return {true, false, true};
    case 7:
      return {true, true, true};
    case 8:
      return {true, true, false};
    default:
      return {false, false, false};
  }
}

}  // namespace

bool swaps_axes(int orientation) { return turn_of(orientation).swap; }

Rect upright(const Rect& window, const Rect& display, int orientation) {
  const Turn turn = turn_of(orientation);
  int x = window.x - display.x, y = window.y - display.y;
  if (turn.flip_x) x = display.width - x - window.width;
  if (turn.flip_y) y = display.height - y - window.height;
  if (!turn.swap) return {display.x + x, display.y + y, window.width, window.height};
  return {display.y + y, display.x + x, window.height, window.width};
}

Image upright(Image image, int orientation) {
  const Turn turn = turn_of(orientation);
  if (!turn.swap && !turn.flip_x && !turn.flip_y) return image;
  Image out(turn.swap ? image.height : image.width, turn.swap ? image.width : image.height, image.channels);
  const std::size_t pixel_bytes = static_cast<std::size_t>(image.channels) * sizeof(float);
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      int source_x = turn.swap ? y : x, source_y = turn.swap ? x : y;
      if (turn.flip_x) source_x = image.width - 1 - source_x;
      if (turn.flip_y) source_y = image.height - 1 - source_y;
      std::memcpy(out.at(x, y), image.at(source_x, source_y), pixel_bytes);
    }
  }
  return out;
}

void turn_vectors(Image& vectors, int orientation) {
  const Turn turn = turn_of(orientation);
  for (std::size_t i = 0; i + 1 < vectors.pixels.size(); i += 2) {
    float &x = vectors.pixels[i], &y = vectors.pixels[i + 1];
    if (turn.flip_x) x = -x;
    if (turn.flip_y) y = -y;
    if (turn.swap) std::swap(x, y);
  }
}

}  // namespace afterglow
