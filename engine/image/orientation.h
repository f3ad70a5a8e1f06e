// SPDX-License-Identifier: MIT
// The eight orientations of TIFF and Exif, undone: the picture as it is meant to be seen.
#pragma once

#include "core/geometry.h"
#include "image/image.h"

namespace afterglow {

/// Whether orientation 1…8 exchanges width and height. Numbers outside 1…8 count as 1 (upright) everywhere here.
bool swaps_axes(int orientation);

/// Where `window` lies once the file is turned upright about its display window `display` (both as stored). The turned
/// display window keeps its origin, with x and y exchanged where the axes are.
Rect upright(const Rect& window, const Rect& display, int orientation);

/// The stored pixels turned upright. Returns `image` itself for 1; else needs a second image of the same size.
Image upright(Image image, int orientation);
/// Vectors in pixels (two channels, x to the right, y down) of pixels that were turned upright point as the pixels do.
void turn_vectors(Image& vectors, int orientation);

}  // namespace afterglow
