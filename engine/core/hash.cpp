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

HashStream::HashStream() : state_(XXH3_createState()) { XXH3_128bits_reset(state_); }
HashStream::~HashStream() { XXH3_freeState(state_); }
void HashStream::add(std::string_view piece) { XXH3_128bits_update(state_, piece.data(), piece.size()); }

Hash HashStream::finish() const {
  const XXH128_hash_t h = XXH3_128bits_digest(state_);
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
