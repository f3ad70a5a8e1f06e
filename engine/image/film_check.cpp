// SPDX-License-Identifier: MIT
#include "image/film_check.h"

#include <optional>
#include <vector>

#include "image/container_bytes.h"
#include "image/dpx_header.h"

namespace afterglow {
namespace {

constexpr const char* kMalformed = "is malformed: its header makes no sense";
constexpr std::uint32_t kUndefined = 0xffffffff, kMostSide = 1u << 20;

/// The header, whose numbers have the order that the file's first four bytes tell.
class FilmHeader {
 public:
  FilmHeader(std::ifstream& in, std::size_t bytes, unsigned char first_if_big)
      : bytes_(bytes_at(in, 0, bytes)), whole_(bytes_.size() == bytes), big_(whole_ && bytes_[0] == first_if_big) {}
  bool whole() const { return whole_; }
  std::uint32_t number(std::size_t at, std::size_t bytes) const {
    return static_cast<std::uint32_t>(ordered(&bytes_[at], bytes, big_));
  }

 private:
  std::vector<unsigned char> bytes_;
  bool whole_, big_;
};

/// Bytes of one line of so many samples.
std::uint64_t packed_line(std::uint64_t samples, std::uint32_t bits) { return (samples * bits + 31) / 32 * 4; }
/// Of three samples of ten bits a word.
std::uint64_t filled_line(std::uint64_t samples) { return (samples + 2) / 3 * 4; }

Result<void> check_pixels(const std::filesystem::path& file, std::uint64_t size, std::uint32_t offset,
                          std::uint32_t lines, std::uint64_t line, std::uint32_t padding) {
  if (offset == kUndefined) return malformed(file, kMalformed);
  if (offset + lines * (line + (padding == kUndefined ? 0 : padding)) > size) return malformed(file, "is truncated");
  return {};
}

/// OpenImageIO makes room for as many bytes of the user's data as the header claims.
Result<void> check_user_data(const std::filesystem::path& file, std::uint64_t size, std::uint32_t bytes) {
  if (bytes != kUndefined && bytes > size) return malformed(file, "is truncated");
  return {};
}

/// How many samples a pixel of this descriptor has. Nothing: the reader does not know it.
std::optional<std::uint32_t> dpx_channels(std::uint32_t descriptor) {
  switch (descriptor) {
    case 50:   // RGB
    case 101:  // CbYACrYA
    case 102:  // CbYCr
      return 3;
    case 51:   // RGBA
    case 52:   // ABGR
    case 103:  // CbYCrA
      return 4;
    case 100:  // CbYCrY
      return 2;
    default:
      if (descriptor >= 150 && descriptor <= 156) return descriptor - 148;
      return descriptor <= 9 ? std::optional(1u) : std::nullopt;
  }
}

}  // namespace

Result<std::uint32_t> check_dpx(const std::filesystem::path& file, std::ifstream& in, std::uint64_t size) {
  constexpr std::size_t kElement = 780;
  const FilmHeader header(in, kElement + 72, 'S');
  if (!header.whole()) return malformed(file, "is truncated");
  AFTERGLOW_CHECK(check_user_data(file, size, header.number(32, 4)));
  const std::uint32_t width = header.number(772, 4), lines = header.number(776, 4);
  const std::uint32_t bits = header.number(kElement + 23, 1), packing = header.number(kElement + 24, 2);
  const auto channels = dpx_channels(header.number(kElement + 20, 1));
  if (width > kMostSide || lines > kMostSide) return 0u;  // refused for its size
  if (!channels || width == 0 || lines == 0 || packing > 2) return malformed(file, kMalformed);
  const std::uint64_t samples = std::uint64_t{width} * *channels;
  std::uint64_t line = samples * bits / 8;
  if (bits == 10 && packing > 0) {
    line = filled_line(samples);
    // The reader leaves a line's last sample unread, or changes places in lines of single samples beyond their end.
    if (samples % 3 == 1 || (*channels == 1 && samples % 3 != 0))
      return malformed(file, "is a 10-bit DPX of a width that cannot be read right with its number of channels");
  } else if ((bits == 10 || bits == 12) && packing == 0) {
    line = packed_line(samples, bits);
  } else if (bits == 12) {
    line = samples * 2;
  } else if (bits != 8 && bits != 16 && bits != 32 && bits != 64) {
    return malformed(file, "has samples of other sizes than 8, 10, 12, 16, 32 or 64 bits");
  }
  const bool runs = header.number(kElement + 26, 2) == 1;
  if (runs) return malformed(file, "is a run-length encoded DPX, which is not supported");
  const std::uint32_t offset = header.number(kElement + 28, 4), padding = header.number(kDpxLinePaddingAt, 4);
  AFTERGLOW_CHECK(check_pixels(file, size, offset, lines, line, padding));
  // Lines begin at words of 32 bits, which the reader does not know, and few writers tell of.
  const std::uint64_t words = (line + 3) / 4 * 4;
  const bool told = padding != 0 && padding != kUndefined;
  return !told && offset + lines * words <= size ? static_cast<std::uint32_t>(words - line) : 0u;
}

Result<void> check_cineon(const std::filesystem::path& file, std::ifstream& in, std::uint64_t size) {
  constexpr std::size_t kElements = 196, kElement = 28;
  const FilmHeader header(in, 692, 0x80);
  if (!header.whole()) return malformed(file, "is truncated");
  AFTERGLOW_CHECK(check_user_data(file, size, header.number(16, 4)));
  const std::uint32_t elements = header.number(193, 1);
  if (elements < 1 || elements > 8) return malformed(file, kMalformed);
  const std::uint32_t bits = header.number(kElements + 2, 1);
  const std::uint32_t width = header.number(kElements + 4, 4), lines = header.number(kElements + 8, 4);
  if (width > kMostSide || lines > kMostSide) return {};  // refused for its size
  if (width == 0 || lines == 0) return malformed(file, kMalformed);
  for (std::size_t i = 1; i < elements; ++i) {
    const std::size_t at = kElements + i * kElement;
    if (header.number(at + 2, 1) != bits || header.number(at + 4, 4) != width || header.number(at + 8, 4) != lines)
      return malformed(file, "has channels of different sizes, which are not supported");
  }
  const std::uint32_t packing = header.number(681, 1);
  const std::uint64_t samples = std::uint64_t{width} * elements;
  std::uint64_t line = samples * bits / 8;
  if (bits == 10 && packing > 0) {
    line = filled_line(samples);
    if (samples % 3 == 1)
      return malformed(file, "is a 10-bit Cineon of a width that cannot be read right with its number of channels");
  } else if (bits == 10 || bits == 12) {
    line = packed_line(samples, bits);
  } else if (bits != 8 && bits != 16) {
    return malformed(file, "has samples of other sizes than 8, 10, 12 or 16 bits");
  }
  return check_pixels(file, size, header.number(4, 4), lines, line, header.number(684, 4));
}

}  // namespace afterglow
