// Depth, normals and motion for pictures that are made.
#pragma once

#include "image/picture.h"
#include "stress/random.h"

namespace afterglow::stress {

/// Adds "depth", "normal" and "motion" of the size of the colour. Gentle: surfaces with edges, some of them infinitely
/// far, unit normals, motion up to 40 pixels. Else also values that are not finite, denormal or absurd.
void add_auxiliary(Picture& picture, Random& random, bool gentle);

}  // namespace afterglow::stress
