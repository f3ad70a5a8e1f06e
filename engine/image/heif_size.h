// SPDX-License-Identifier: MIT
// How large a HEIF or AVIF file says that it is. Internal to the room.
#pragma once

#include <cstdint>
#include <fstream>
#include <optional>

#include "image/claimed_size.h"

namespace afterglow {

/// The largest of what its items claim (`ispe` properties) and of the canvases that its grids and overlays of items are
/// put together on (ISO/IEC 23008-12, 6.6.2), which libheif takes the memory of. Nothing where the file has none.
std::optional<ClaimedSize> heif_size(std::ifstream& in, std::uint64_t size);

}  // namespace afterglow
