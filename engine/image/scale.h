// SPDX-License-Identifier: MIT
// Pictures made smaller (or larger) before the stack, for a quick look: --size, proxies.
#pragma once

#include <string>

#include "core/geometry.h"
#include "core/result.h"
#include "image/picture.h"

namespace afterglow {

/// What --size asks for: both sides, one of them, or a share; what is left open keeps the picture's shape.
struct SizeWish {
  int width = 0, height = 0;  ///< 0: left open
  double share = 0;           ///< of both sides, when neither is given
  /// At least 1×1, at most 16384 on a side that is given.
  Size of(Size display) const;
  /// Whether it asks for another shape than that of the picture, by more than a rounding to even sides.
  bool reshapes(Size display) const;
};

/// "1280x720", "1280" (the width), "x720", "50%". Errors: usage.
Result<SizeWish> parse_size_wish(const std::string& text);

/// Size of a data window when its display window is scaled to `target`; at least 1×1.
Size scaled_size(Size data, Size display, Size target);

/// The data window of a picture whose display window is scaled so: the display window keeps its corner, the data window
/// its place in it.
Rect scaled_window(const Rect& data, const Rect& display, Size target);

/// What a picture is scaled to before the stack: its display window to `display`, and everything `finer` times as large
/// as that. A result is scaled back by `shrink_picture`.
struct Scaling {
  Size display;
  int finer = 1;
};

/// Colour becomes the mean over each target pixel's area (bilinear when enlarging); depth and normals take the nearest
/// texel, since values between two surfaces mean nothing.
void scale_picture(Picture& picture, const Scaling& scaling);

/// The colour of a result whose sides are multiples of `finer`, as the mean of finer×finer pixels; its windows alike.
void shrink_picture(Picture& picture, int finer);

}  // namespace afterglow
