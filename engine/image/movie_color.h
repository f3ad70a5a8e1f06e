// SPDX-License-Identifier: MIT
// What the colour codes of a video mean (ITU-T H.273), and what is taken where it says nothing.
#pragma once

#include "image/color_encoding.h"
#include "image/movie_source.h"

namespace afterglow {

/// The number of H.273 that says nothing.
inline constexpr int kUnsaid = 2;

/// Fills in the matrix, primaries and transfer that a video does not say, and notes what was taken: RGB and codecs of
/// still pictures are sRGB; anything else is BT.709, or BT.601 when it is no larger than standard definition. A matrix
/// of BT.709 or BT.2020 that it says tells of its primaries, and primaries of BT.2020 of its matrix. Errors (io, "is
/// …"): a matrix of which no RGB is made.
Result<void> fill_in(MovieFacts& facts);

/// Curve and primaries by their numbers in H.273, over what `encoding` has; 2 leaves them. False: one has no meaning
/// here, and nothing is changed.
bool use_codes(int primaries, int transfer, ColorEncoding& encoding);

/// From stored RGB to light of the scene: curves of cameras are undone (BT.709, BT.601, BT.2020: the camera's curve,
/// not a display's), PQ and HLG as the input spaces "pq" and "hlg". `facts` are filled in.
ColorEncoding movie_encoding(const MovieFacts& facts);

}  // namespace afterglow
