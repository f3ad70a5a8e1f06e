// SPDX-License-Identifier: MIT
// What the checks of containers share. Internal to the room.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>

#include "core/result.h"

namespace afterglow {

/// A number of so many bytes (4 at most), the highest first.
inline std::uint32_t big_endian(const unsigned char* p, std::size_t bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < bytes; ++i) value = value << 8 | p[i];
  return value;
}

/// The same, the lowest first.
inline std::uint32_t little_endian(const unsigned char* p, std::size_t bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = bytes; i > 0; --i) value = value << 8 | p[i - 1];
  return value;
}

inline Error malformed(const std::filesystem::path& file, const char* why) {
  return Error{ErrorKind::io, why, file.string()};
}

/// False: the file ends before.
inline bool fill(std::ifstream& in, unsigned char* into, std::size_t size) {
  return static_cast<bool>(in.read(reinterpret_cast<char*>(into), static_cast<std::streamsize>(size)));
}

}  // namespace afterglow
