// SPDX-License-Identifier: MIT
// The plain meaning of a core/filter.h Filter: what any way of executing a filter pass must give.
#pragma once

#include <vector>

#include "core/filter.h"
#include "reference/double_image.h"

namespace afterglow::reference {

/// out(X, Y) = Σ weight · I(px + dx, py + dy) over all channels, alpha included; see Filter for the terms.
DoubleImage resample(const DoubleImage& source, Size size, const Filter& filter);

/// Mean over `ratio` texels along an axis, 1 or more: each once where they are whole, else twice as many reads as
/// texels.
std::vector<Tap> mean_over(double ratio);

/// The picture at another size: halved while that leaves enough, then the mean of reads at most half a texel apart.
DoubleImage resized_to(DoubleImage image, Size size);

/// The next level of a pyramid: half of each side, rounded down; a line of pixels stays one.
Size halved(Size size);

}  // namespace afterglow::reference
