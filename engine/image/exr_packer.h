// SPDX-License-Identifier: MIT
// How the chunks of an EXR are packed by one of its methods.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace afterglow {

/// One thread's; keeps its memory from chunk to chunk.
class ExrPacker {
 public:
  ExrPacker() = default;
  virtual ~ExrPacker() = default;
  ExrPacker(const ExrPacker&) = delete;
  ExrPacker& operator=(const ExrPacker&) = delete;

  /// What a file stores for a chunk of these bytes: `packed`, which is made as long as that is, or the bytes themselves
  /// where packing makes them no shorter.
  virtual std::span<const std::uint8_t> run(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& packed) = 0;
};

}  // namespace afterglow
