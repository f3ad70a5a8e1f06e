// SPDX-License-Identifier: MIT
#include "core/hash.h"

#include <fmt/format.h>
#include <xxhash.h>

namespace afterglow {

std::string Hash::hex() const { return fmt::format("{:016x}{:016x}", high, low); }

Hash hash_bytes(const void* data, std::size_t size) {
  const XXH128_hash_t h = XXH3_128bits(data, size);
  return {h.high64, h.low64};
}

Hasher& Hasher::add(std::string_view text) {
  add(static_cast<std::uint64_t>(text.size()));
  joined_ += text;
  return *this;
}

Hasher& Hasher::add(std::uint64_t number) {
  joined_.append(reinterpret_cast<const char*>(&number), sizeof number);
  return *this;
}

}  // namespace afterglow
