// SPDX-License-Identifier: MIT
// The picture that is measured when none is given.
#pragma once

#include "image/picture.h"

namespace afterglow::bench {

/// Lit spheres, lamps and tubes up to 40 before a dim wall, with grain; depth and unit normals. The same scene at every
/// size, the same values every time; all values are exact halves, so that storage in half floats loses nothing of the
/// source.
Picture make_picture(Size size);

}  // namespace afterglow::bench
