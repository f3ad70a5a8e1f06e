// SPDX-License-Identifier: MIT
// What the rows of an invocation make alike is made once: above all the texels that neighbouring pixels both read. A
// shader that reads at `pixel + ivec2(0, 1)` reads in its row what the next one finds at `pixel`. Internal to the room.
#pragma once

#include <cstdint>
#include <vector>

namespace afterglow {

struct MergedRows {
  std::vector<std::uint32_t> spirv;
  std::size_t reads_before = 0, reads = 0;  ///< texels that stand in the text
  bool loops = false;                       ///< some are left
};

/// Within each block of each function: equal steps on equal values become one; so do reads of an image that nothing
/// writes to. Sums of whole numbers with constants are told apart by the total. Results are the same bits.
MergedRows merge_equal(std::vector<std::uint32_t> spirv);

}  // namespace afterglow
