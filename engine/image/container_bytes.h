// SPDX-License-Identifier: MIT
// What the checks of containers share. Internal to the room.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "core/result.h"

namespace afterglow {

/// A number of so many bytes (8 at most), the highest or the lowest first.
inline std::uint64_t ordered(const unsigned char* p, std::size_t bytes, bool highest_first) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < bytes; ++i) value = value << 8 | p[highest_first ? i : bytes - 1 - i];
  return value;
}

/// The same of 4 bytes at most.
inline std::uint32_t big_endian(const unsigned char* p, std::size_t bytes) {
  return static_cast<std::uint32_t>(ordered(p, bytes, true));
}
inline std::uint32_t little_endian(const unsigned char* p, std::size_t bytes) {
  return static_cast<std::uint32_t>(ordered(p, bytes, false));
}

/// Puts such a number of so many bytes.
inline void put_ordered(unsigned char* p, std::size_t bytes, std::uint64_t value, bool highest_first) {
  for (std::size_t i = 0; i < bytes; ++i, value >>= 8)
    p[highest_first ? bytes - 1 - i : i] = static_cast<unsigned char>(value & 255);
}

inline Error malformed(const std::filesystem::path& file, std::string why) {
  return Error{ErrorKind::io, std::move(why), file.string()};
}

/// False: the file ends before.
inline bool fill(std::ifstream& in, unsigned char* into, std::size_t size) {
  return static_cast<bool>(in.read(reinterpret_cast<char*>(into), static_cast<std::streamsize>(size)));
}

/// So many bytes from a place on, fewer where the file ends before.
inline std::vector<unsigned char> bytes_at(std::ifstream& in, std::uint64_t at, std::uint64_t count) {
  std::vector<unsigned char> bytes(count);
  in.clear();
  in.seekg(static_cast<std::streamoff>(at));
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(count));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(in.gcount(), 0)));
  in.clear();
  return bytes;
}

}  // namespace afterglow
