// SPDX-License-Identifier: MIT
#include "image/numbered_check.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <span>
#include <string_view>
#include <vector>

#include "image/container_bytes.h"

namespace afterglow {
namespace {

constexpr const char* kNoColor = "is damaged: a pixel has a colour that its table does not hold";

/// Whether every pixel of a Targa has a colour; where it ends too early its reader says so.
bool targa_colors_exist(std::span<const unsigned char> bytes, bool packed) {
  const std::uint32_t colors = little_endian(&bytes[5], 2);
  const std::size_t pixel = (bytes[16] + 7u) / 8;
  const std::uint64_t pixels = std::uint64_t{little_endian(&bytes[12], 2)} * little_endian(&bytes[14], 2);
  if (pixel < 1 || pixel > 4) return false;  // of none it would never come to an end
  std::size_t at = 18u + bytes[0] + std::size_t{colors} * ((bytes[7] + 7u) / 8);
  const auto exists = [&] {
    const std::uint64_t number = little_endian(&bytes[at], pixel);
    at += pixel;
    return number < colors;
  };
  for (std::uint64_t done = 0; done < pixels;) {
    std::uint64_t stored = 1, made = 1;
    if (packed) {
      if (at >= bytes.size()) break;
      made = (bytes[at] & 0x7fu) + 1;
      stored = (bytes[at] & 0x80) != 0 ? 1 : made;
      ++at;
    }
    for (; stored > 0; --stored) {
      if (at + pixel > bytes.size()) return true;
      if (!exists()) return false;
    }
    done += made;
  }
  return true;
}

/// Where a Targa's extension begins; 0: it has none.
std::uint64_t targa_extension(std::span<const unsigned char> bytes) {
  constexpr std::size_t kFooter = 26, kExtension = 495;
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (bytes.size() < kFooter || !text.substr(bytes.size() - 18).starts_with("TRUEVISION-XFILE.")) return 0;
  const std::uint64_t at = little_endian(&bytes[bytes.size() - kFooter], 4);
  return at + 2 <= bytes.size() && little_endian(&bytes[at], 2) >= kExtension ? at : 0;
}

/// Author, job and program of the extension end inside of their places.
bool targa_texts_end(std::span<const unsigned char> bytes) {
  constexpr std::size_t kText = 41;
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::uint64_t at = targa_extension(bytes);
  if (at == 0) return true;
  for (const std::uint64_t place : {at + 2, at + 379, at + 426})
    if (place + kText <= bytes.size() && text.substr(place, kText).find('\0') == text.npos) return false;
  return true;
}

/// The codes of a GIF's picture, which give colours' numbers below `clear`, or repeat what was given.
class GifCodes {
 public:
  GifCodes(std::span<const unsigned char> bytes, std::size_t at) : bytes_(bytes), at_(at) {}

  /// False: a number of `colors` or more. `bits`: of a number.
  bool below(std::uint32_t colors, unsigned bits) {
    const std::uint32_t clear = 1u << bits, end = clear + 1;
    unsigned width = bits + 1;
    std::uint32_t next = end + 1;
    while (true) {
      const auto code = read(width);
      if (!code || *code == end) return true;
      if (*code < clear && *code >= colors) return false;
      if (*code == clear) {
        width = bits + 1;
        next = end + 1;
      } else if (next < 4097 && ++next > 1u << width && width < 12) {
        ++width;
      }
    }
  }

 private:
  std::optional<std::uint32_t> read(unsigned width) {
    while (held_ < width) {
      if (left_ == 0) {
        if (at_ >= bytes_.size() || bytes_[at_] == 0) return {};
        left_ = bytes_[at_++];
      }
      if (at_ >= bytes_.size()) return {};
      store_ |= std::uint32_t{bytes_[at_++]} << held_;
      held_ += 8;
      --left_;
    }
    const std::uint32_t code = store_ & ((1u << width) - 1);
    store_ >>= width;
    held_ -= width;
    return code;
  }

  std::span<const unsigned char> bytes_;
  std::size_t at_, left_ = 0;
  std::uint32_t store_ = 0;
  unsigned held_ = 0;
};

}  // namespace

Result<ClaimedSize> check_targa(const std::filesystem::path& file, std::ifstream& in, std::uint64_t size) {
  const std::vector<unsigned char> bytes = bytes_at(in, 0, size);
  if (bytes.size() < 18) return malformed(file, "is truncated");
  const unsigned kind = bytes[2];
  if (kind == 1 || kind == 9) {
    if (little_endian(&bytes[3], 2) != 0)
      return malformed(file, "has a table of colours that does not begin at 0, which is not read; write it anew");
    if (!targa_colors_exist(bytes, kind == 9)) return malformed(file, kNoColor);
  }
  if (!targa_texts_end(bytes)) return malformed(file, "is damaged: a text of its extension has no end");
  return ClaimedSize{{static_cast<int>(little_endian(&bytes[12], 2)), static_cast<int>(little_endian(&bytes[14], 2))},
                     4};
}

Result<std::optional<ClaimedSize>> check_bmp(const std::filesystem::path& file, std::ifstream& in) {
  constexpr std::uint32_t kOldHeader = 12, kRuns8 = 1, kRuns4 = 2, kMasks = 3;
  std::array<unsigned char, 34> head{};
  in.seekg(0);
  if (!fill(in, head.data(), head.size())) return malformed(file, "is truncated");
  if (little_endian(&head[14], 4) == kOldHeader) return std::optional<ClaimedSize>();
  const auto side = [&](std::size_t at) {
    const auto length = static_cast<std::int32_t>(little_endian(&head[at], 4));
    return static_cast<int>(std::min<std::int64_t>(std::abs(std::int64_t{length}), 0x7fffffff));
  };
  const std::uint32_t bits = little_endian(&head[28], 2), packing = little_endian(&head[30], 4);
  if (packing == kMasks && bits == 32) {  // OpenImageIO 2.4 looks at those of 16 bits alone
    std::array<unsigned char, 12> masks{};
    in.seekg(54);
    if (!fill(in, masks.data(), masks.size())) return malformed(file, "is truncated");
    if (little_endian(masks.data(), 4) != 0xff0000 || little_endian(&masks[4], 4) != 0xff00 ||
        little_endian(&masks[8], 4) != 0xff)
      return malformed(file, "holds its channels in an order that is not read; write it anew");
  }
  if (packing != kRuns8 && packing != kRuns4) return std::optional<ClaimedSize>();
  if (bits != 8 && bits != 4) return malformed(file, "is damaged: only pictures of 4 or 8 bits are packed so");
  return std::optional(ClaimedSize{{side(18), side(22)}, 3});  // it is unpacked (unpack_bmp.h)
}

bool pads_targa(std::ifstream& in, std::uint64_t size) {
  constexpr unsigned kStraight = 3, kAssociated = 4;
  constexpr std::uint64_t kAttributes = 494;  // in the extension
  const std::vector<unsigned char> head = bytes_at(in, 0, 18);
  if (head.size() < 18 || head[16] != 32 || (head[17] & 15) != 0) return false;
  const std::vector<unsigned char> bytes = bytes_at(in, 0, size);
  const std::uint64_t at = targa_extension(bytes);
  const unsigned attributes = at != 0 && at + kAttributes < bytes.size() ? bytes[at + kAttributes] : 0;
  return attributes != kStraight && attributes != kAssociated;
}

bool pads_bmp(std::ifstream& in, std::uint64_t size) {
  constexpr std::uint32_t kWithAlpha = 56, kPlain = 0, kMasks = 3;  // a header so long has a mask for alpha
  constexpr std::uint64_t kTogether = 1 << 16;                      // of bytes, whole pixels
  const std::vector<unsigned char> head = bytes_at(in, 0, 70);
  if (head.size() < 34 || little_endian(&head[28], 2) != 32) return false;
  const std::uint32_t header = little_endian(&head[14], 4), packing = little_endian(&head[30], 4);
  if (packing != kPlain && packing != kMasks) return false;
  if (header >= kWithAlpha && head.size() >= 70 && little_endian(&head[66], 4) != 0) return false;
  for (std::uint64_t from = little_endian(&head[10], 4); from < size; from += kTogether) {
    const std::vector<unsigned char> pixels = bytes_at(in, from, kTogether);
    for (std::size_t at = 3; at < pixels.size(); at += 4)
      if (pixels[at] != 0) return false;
  }
  return true;
}

Result<void> check_gif(const std::filesystem::path& file, std::ifstream& in, std::uint64_t size) {
  const std::vector<unsigned char> bytes = bytes_at(in, 0, size);
  if (bytes.size() < 13) return malformed(file, "is truncated");
  const auto table = [](unsigned flags) { return (flags & 0x80) != 0 ? 2u << (flags & 7) : 0u; };
  std::uint32_t colors = table(bytes[10]);
  for (std::size_t at = 13 + std::size_t{3} * colors; at < bytes.size();) {
    const unsigned kind = bytes[at++];
    if (kind == 0x21) {  // an extension: a label, then blocks of at most 255 bytes
      for (++at; at < bytes.size() && bytes[at] != 0;) at += 1u + bytes[at];
      ++at;
    } else if (kind == 0x2c && at + 9 < bytes.size()) {
      if (const std::uint32_t own = table(bytes[at + 8]); own > 0) colors = own, at += std::size_t{3} * own;
      at += 9;
      if (colors == 0) break;
      const bool sound = at >= bytes.size() || bytes[at] > 8 || GifCodes(bytes, at + 1).below(colors, bytes[at]);
      return sound ? Result<void>() : malformed(file, kNoColor);
    } else {
      break;
    }
  }
  return {};
}

}  // namespace afterglow
