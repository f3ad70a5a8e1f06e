// SPDX-License-Identifier: MIT
#include "shader/kernel_file.h"

#include <cstring>

namespace afterglow {
namespace {

constexpr std::uint32_t kMagic = 0x4b4c4741;  // "AGLK"
constexpr std::uint32_t kSpirvMagic = 0x07230203;
constexpr std::uint32_t kMaxWords = 16u << 20;

/// Caches stay on the machine that wrote them: numbers are in its own byte order, and the magic tells another's apart.
struct Header {
  std::uint32_t magic, version;
  std::uint64_t length;               ///< bytes behind the header
  std::uint64_t hash_high, hash_low;  ///< of them
};
struct Fixed {
  std::uint64_t text_high, text_low;
  std::uint32_t block_size, offsets, unset, loops, words;
  std::uint32_t rows_pay;
};

/// Takes `count` words off the front, which are known to be there.
std::vector<std::uint32_t> take_words(std::string_view& bytes, std::size_t count) {
  std::vector<std::uint32_t> words(count);
  if (count > 0) std::memcpy(words.data(), bytes.data(), count * sizeof(std::uint32_t));
  bytes.remove_prefix(count * sizeof(std::uint32_t));
  return words;
}

void append(std::string& out, const void* data, std::size_t size) {
  if (size > 0) out.append(static_cast<const char*>(data), size);
}

}  // namespace

std::string encode(const KernelFile& kernel) {
  std::string content;
  const Fixed fixed{kernel.text.high,
                    kernel.text.low,
                    kernel.block_size,
                    static_cast<std::uint32_t>(kernel.offsets.size()),
                    static_cast<std::uint32_t>(kernel.unset.size()),
                    static_cast<std::uint32_t>(kernel.loops.size()),
                    static_cast<std::uint32_t>(kernel.spirv.size()),
                    kernel.rows_pay ? 1u : 0u};
  append(content, &fixed, sizeof fixed);
  append(content, kernel.offsets.data(), kernel.offsets.size() * sizeof(std::uint32_t));
  append(content, kernel.unset.data(), kernel.unset.size() * sizeof(std::uint32_t));
  append(content, kernel.loops.data(), kernel.loops.size() * sizeof(std::uint32_t));
  append(content, kernel.spirv.data(), kernel.spirv.size() * sizeof(std::uint32_t));
  const Hash hash = hash_text(content);
  const Header header{kMagic, kKernelFileVersion, content.size(), hash.high, hash.low};
  std::string out;
  append(out, &header, sizeof header);
  return out + content;
}

std::optional<KernelFile> decode(std::string_view bytes) {
  Header header;
  Fixed fixed;
  if (bytes.size() < sizeof header + sizeof fixed) return std::nullopt;
  std::memcpy(&header, bytes.data(), sizeof header);
  bytes.remove_prefix(sizeof header);
  if (header.magic != kMagic || header.version != kKernelFileVersion || header.length != bytes.size())
    return std::nullopt;
  if (hash_text(bytes) != Hash{header.hash_high, header.hash_low}) return std::nullopt;
  std::memcpy(&fixed, bytes.data(), sizeof fixed);
  bytes.remove_prefix(sizeof fixed);
  if (fixed.offsets > kMaxWords || fixed.unset > kMaxWords || fixed.loops > kMaxWords || fixed.words > kMaxWords)
    return std::nullopt;
  if (bytes.size() != (std::size_t{fixed.offsets} + fixed.unset + fixed.loops + fixed.words) * sizeof(std::uint32_t))
    return std::nullopt;
  KernelFile kernel{{fixed.text_high, fixed.text_low}, fixed.block_size, fixed.rows_pay != 0, {}, {}, {}, {}};
  kernel.offsets = take_words(bytes, fixed.offsets);
  kernel.unset = take_words(bytes, fixed.unset);
  kernel.loops = take_words(bytes, fixed.loops);
  kernel.spirv = take_words(bytes, fixed.words);
  if (kernel.spirv.empty() || kernel.spirv[0] != kSpirvMagic) return std::nullopt;
  return kernel;
}

}  // namespace afterglow
