// SPDX-License-Identifier: MIT
// A compiled kernel as bytes of a cache file. Internal to the room.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/hash.h"

namespace afterglow {

/// Raise when the bytes change. What compiles is in the name of the file (KernelCompiler).
inline constexpr std::uint32_t kKernelFileVersion = 11;

struct KernelFile {
  Hash text;  ///< of the assembled GLSL it was made from
  std::uint32_t block_size = 0;
  bool rows_pay = false;               ///< see CompiledKernel
  std::vector<std::uint32_t> offsets;  ///< of the parameters, in the order of AssembledKernel::params
  std::vector<std::uint32_t> unset;    ///< numbers of the variables that may be read before they have a value
  std::vector<std::uint32_t>
      loops;  ///< of a guarded kernel: file (in AssembledKernel::file_names) and line of each loop
  std::vector<std::uint32_t> spirv;
};

/// Magic, version, length and hash of the content, then the content.
std::string encode(const KernelFile& kernel);
/// Nothing when the bytes are not exactly what `encode` made.
std::optional<KernelFile> decode(std::string_view bytes);

}  // namespace afterglow
