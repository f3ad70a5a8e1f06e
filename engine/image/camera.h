// SPDX-License-Identifier: MIT
// Where a picture was taken from, as its file says it.
#pragma once

#include <array>
#include <optional>

#include "image/metadata.h"

namespace afterglow {

/// The camera's place in the scene, from EXR's `worldToCamera` (row vectors: camera = world · M). Empty when there is
/// none, or when the matrix is not finite or flattens space.
std::optional<std::array<double, 3>> camera_position(const Metadata& metadata);

}  // namespace afterglow
