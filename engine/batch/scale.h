// --size: pictures made smaller (or larger) before the stack, for a quick look.
#pragma once

#include "core/geometry.h"
#include "image/picture.h"

namespace afterglow {

/// Size of a data window when its display window is scaled to `target`; at least 1×1.
Size scaled_size(Size data, Size display, Size target);

/// The data window of a picture whose display window is scaled so: the display window keeps its corner, the data window
/// its place in it.
Rect scaled_window(const Rect& data, const Rect& display, Size target);

/// Scales so that the display window becomes `target`. Colour with a triangle filter as wide as a target pixel
/// (bilinear when enlarging); depth and normals take the nearest texel, since values between two surfaces mean nothing.
void scale_picture(Picture& picture, Size target);

}  // namespace afterglow
