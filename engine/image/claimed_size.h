// SPDX-License-Identifier: MIT
// How large pictures say they are, in formats whose readers take memory for the whole picture as soon as they open a
// file.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/geometry.h"

namespace afterglow {

struct ClaimedSize {
  Size size;
  std::uint64_t bytes_per_pixel = 0;  ///< that the reader keeps of the whole picture
};

/// Sides as a file says them, held within an int.
Size claimed_sides(std::uint64_t width, std::uint64_t height);

/// From the first bytes of a GIF (logical screen) or WebP (canvas or frame); 30 are enough. Nothing for other formats
/// and headers that end too early, which readers refuse.
std::optional<ClaimedSize> claimed_size(std::span<const unsigned char> head);

}  // namespace afterglow
