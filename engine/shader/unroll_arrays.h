// SPDX-License-Identifier: MIT
// Loops that step through arrays. Internal to the room.
//
// An array whose indices are all known is registers; any other is memory of each pixel, which drivers read and write
// element by element. So a loop of a known number of turns that steps through one becomes straight code, with the loops
// within it: `for (int i = 0; i < 25; ++i) sum += weights[i] * …`, a sort of 25 colours. Drivers do so themselves as
// long as they see where a loop ends; not where the inner one begins at the outer one's number, and not once indices
// are held within their arrays (with_held_indices).
#pragma once

#include <cstdint>
#include <vector>

namespace afterglow {

struct ArraysUnrolled {
  std::vector<std::uint32_t> spirv;
  std::vector<std::uint32_t> loops;  ///< for each OpLoopMerge, in order: which of those of the module before it was
};

/// Results are the same bits. Loops that would become too long, that are left elsewhere than by their test, within
/// which others turn that stay, or whose indices are not known either way, are left as they are; so are all beyond some
/// tens, and those over the taps of filters: they are loops because many taps take long to compile. `rows`: how many
/// times over the kernel does all of its work.
ArraysUnrolled unroll_over_arrays(std::vector<std::uint32_t> spirv, int rows);

}  // namespace afterglow
