// SPDX-License-Identifier: MIT
// Rows of pixels side by side: the work on one row is a long chain of dependent steps, in which a processor mostly
// waits; the steps of several rows taken in turns fill the gaps. Internal to the room.
//
// A GPU hides such waits by running other pixels meanwhile; a CPU device does not, and its compiler keeps the order of
// the text. (lavapipe: a tone curve of 7.5 ns a pixel takes 3.8 when four rows take turns.)
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace afterglow {

/// The function of an assembled kernel that main() calls once for every row.
inline constexpr std::string_view kRowFunction = "ag_stages";

/// Replaces main()'s calls of kRowFunction, `together` at a time, by its instructions in turns. Results are the same
/// bits. Nothing where the function branches, or loops more than a few times, or a module is not as expected.
std::optional<std::vector<std::uint32_t>> interleave_rows(const std::vector<std::uint32_t>& spirv, int together);

}  // namespace afterglow
