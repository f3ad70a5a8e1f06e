// SPDX-License-Identifier: MIT
// Depth, normals, motion and a layer for pictures that are made.
#pragma once

#include <map>
#include <string>

#include "image/picture.h"
#include "stress/random.h"

namespace afterglow::stress {

/// A layer that pictures have, for masks: its values lie in 0…1.
inline constexpr const char* kMatte = "layer:matte";

/// All that pictures of this size have besides their colour, as BuildContext wants it.
std::map<std::string, Size> auxiliary_sizes(Size size);

/// Adds "depth", "normal", "motion" and the layer, of the size of the colour. Gentle: surfaces with edges, some of them
/// infinitely far, unit normals, motion up to 40 pixels. Else also values that are not finite, denormal or absurd.
void add_auxiliary(Picture& picture, Random& random, bool gentle);

}  // namespace afterglow::stress
