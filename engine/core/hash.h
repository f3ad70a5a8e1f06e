// SPDX-License-Identifier: MIT
// Content hashes (XXH3, 128 bits): cache keys and change detection. Not for security.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

struct XXH3_state_s;  // of xxHash

namespace afterglow {

struct Hash {
  std::uint64_t high = 0, low = 0;
  friend bool operator==(const Hash&, const Hash&) = default;
  friend auto operator<=>(const Hash&, const Hash&) = default;  // NOLINT(modernize-use-nullptr)
  std::string hex() const;                                      ///< 32 lower-case hexadecimal digits
};

Hash hash_bytes(const void* data, std::size_t size);
inline Hash hash_text(std::string_view text) { return hash_bytes(text.data(), text.size()); }

/// hash_text of a text that comes in pieces.
class HashStream {
 public:
  HashStream();
  ~HashStream();
  HashStream(const HashStream&) = delete;
  HashStream& operator=(const HashStream&) = delete;
  void add(std::string_view piece);
  Hash finish() const;

 private:
  XXH3_state_s* state_;
};

/// Hash of several texts; boundaries count ("ab","c" differs from "a","bc").
class Hasher {
 public:
  Hasher& add(std::string_view text);
  Hasher& add(std::uint64_t number);
  Hash finish() const { return hash_text(joined_); }

 private:
  std::string joined_;
};

}  // namespace afterglow
