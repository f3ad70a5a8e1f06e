// SPDX-License-Identifier: MIT
// PNG's row filters.
#pragma once

#include <cstddef>
#include <cstdint>

namespace afterglow {

/// Filters `row` (`size` bytes, pixels of `pixel` bytes) into `out`, which has room for 1 + size bytes and gets the
/// number of the filter first. `above` is the row before, or null. Takes the filter with the smallest sum of absolute
/// differences, as libpng does. `scratch` has room for 4 · size bytes.
void png_filter_row(const std::uint8_t* row, const std::uint8_t* above, std::size_t size, std::size_t pixel,
                    std::uint8_t* scratch, std::uint8_t* out);

}  // namespace afterglow
