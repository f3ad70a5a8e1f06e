// SPDX-License-Identifier: MIT
// What a kernel's SPIR-V really declares, by SPIRV-Cross. Internal to the room.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/result.h"

namespace afterglow {

struct Reflection {
  struct Member {
    std::uint32_t offset = 0;
    std::uint32_t components = 1;  ///< of a vector, or a matrix's columns
    std::uint32_t columns = 1;     ///< of a matrix
    std::uint32_t elements = 0;    ///< of an array; 0: it is none
  };
  std::map<std::string, Member> members;      ///< of the uniform block at set 0, binding 0
  std::uint32_t block_size = 0;               ///< bytes, a multiple of 16; 0: no block
  std::vector<std::uint32_t> image_bindings;  ///< of images in set 0, sorted
};

/// Errors (other): SPIR-V that cannot be parsed, resources that no kernel has.
Result<Reflection> reflect(const std::vector<std::uint32_t>& spirv);

}  // namespace afterglow
