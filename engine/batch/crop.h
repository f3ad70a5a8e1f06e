// SPDX-License-Identifier: MIT
// --region: a part of the picture, counted from the upper left corner of what a display shows (the display window).
#pragma once

#include "core/geometry.h"
#include "core/result.h"
#include "image/picture.h"

namespace afterglow {

/// Where the region lies in the data window, in pixels of the image. Errors: io (the region reaches beyond the display
/// window, or the picture has no pixels there).
Result<Rect> part_of_region(const Rect& region, const Rect& data_window, const Rect& display_window);

/// Cuts all images down to `part` of them, which is where `region` lies; the picture is then as large as the region,
/// with its upper left corner at (0, 0).
void crop_picture(Picture& picture, const Rect& region, const Rect& part);

}  // namespace afterglow
