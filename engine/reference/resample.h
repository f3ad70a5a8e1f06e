// SPDX-License-Identifier: MIT
// The plain meaning of a core/filter.h Filter: what any way of executing a filter pass must give.
#pragma once

#include "core/filter.h"
#include "reference/double_image.h"

namespace afterglow::reference {

/// out(X, Y) = Σ weight · I(px + dx, py + dy) over all channels, alpha included; see Filter for the terms.
DoubleImage resample(const DoubleImage& source, Size size, const Filter& filter);

/// The picture at another size: halved while that leaves enough, then the mean of reads at most half a texel apart.
DoubleImage resized_to(DoubleImage image, Size size);

/// The next level of a pyramid: half of each side, rounded down; a line of pixels stays one.
Size halved(Size size);

}  // namespace afterglow::reference
