// SPDX-License-Identifier: MIT
// Colour blit (math.md §7): green light alone.
#pragma once

#include "reference/double_image.h"

namespace afterglow::reference {

/// c · (0, I, 0, 1), I clamped to 0…2; I = 0 leaves the source as it is.
DoubleImage color_blit(const DoubleImage& source, double intensity);

}  // namespace afterglow::reference
