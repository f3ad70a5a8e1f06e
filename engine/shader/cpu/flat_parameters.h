// SPDX-License-Identifier: MIT
// Parameters that come from the vertex shader. Internal to the room; see flat_parameters in shader/kernel.h.
//
// lavapipe reads a number of a uniform block for each pixel by itself, and asks for each whether it lies inside the
// block: some thirty instructions for eight pixels (Mesa 22.3). What a vertex shader hands on, without interpolation,
// is one.
#pragma once

#include <compare>
#include <cstdint>
#include <vector>

#include "shader/kernel.h"

namespace afterglow {

/// A number of 32 bits that a kernel is given, by its place.
struct GivenNumber {
  bool in_block = false;     ///< in the uniform block, not in the push constants
  std::uint32_t offset = 0;  ///< bytes
  friend auto operator<=>(const GivenNumber&, const GivenNumber&) = default;
};

/// The full-screen triangle of gpu/fullscreen_vertex.h as SPIR-V, which also hands on these numbers, four a location.
/// What is left of the locations is 0.
std::vector<std::uint32_t> triangle_that_hands_on(const std::vector<GivenNumber>& numbers, std::uint32_t locations);

}  // namespace afterglow
