// SPDX-License-Identifier: MIT
// Content hashes (XXH3, 128 bits): cache keys and change detection. Not for security.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace afterglow {

struct Hash {
  std::uint64_t high = 0, low = 0;
  friend bool operator==(const Hash&, const Hash&) = default;
  friend auto operator<=>(const Hash&, const Hash&) = default;  // NOLINT(modernize-use-nullptr)
  std::string hex() const;                                      ///< 32 lower-case hexadecimal digits
};

Hash hash_bytes(const void* data, std::size_t size);
inline Hash hash_text(std::string_view text) { return hash_bytes(text.data(), text.size()); }

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
