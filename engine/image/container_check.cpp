// SPDX-License-Identifier: MIT
#include "image/container_check.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <span>
#include <string_view>
#include <vector>

#include "core/saturated.h"
#include "image/claimed_size.h"
#include "image/container_bytes.h"
#include "image/exr_header.h"
#include "image/sgi_check.h"

namespace afterglow {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kPngMagic = "\x89PNG\r\n\x1a\n";

/// The checksum of chunk type and data. Told here, damage is one error of ours; libpng would print its own line
/// besides.
Result<void> check_sum(const fs::path& file, std::ifstream& in, std::uint64_t at, std::uint64_t length) {
  std::vector<unsigned char> buffer(std::min<std::uint64_t>(length + 4, 1 << 18));
  in.seekg(static_cast<std::streamoff>(at + 4));
  uLong sum = crc32(0, nullptr, 0);
  for (std::uint64_t left = length + 4; left > 0;) {
    const std::size_t count = std::min<std::uint64_t>(left, buffer.size());
    if (!fill(in, buffer.data(), count)) return malformed(file, "is truncated");
    sum = crc32(sum, buffer.data(), static_cast<uInt>(count));
    left -= count;
  }
  std::array<unsigned char, 4> stored{};
  if (!fill(in, stored.data(), stored.size())) return malformed(file, "is truncated");
  if (big_endian(stored.data(), 4) != sum) return malformed(file, "is damaged: a checksum is wrong");
  return {};
}

/// Walks the chunks up to IEND.
Result<ContainerFacts> check_png(const fs::path& file, std::ifstream& in, std::uint64_t size) {
  ContainerFacts facts;
  facts.kind = ContainerFacts::Kind::png;
  std::uint64_t at = kPngMagic.size();
  while (true) {
    std::array<unsigned char, 8> head{};
    in.seekg(static_cast<std::streamoff>(at));
    if (!fill(in, head.data(), head.size())) return malformed(file, "is truncated");
    const std::uint64_t length = big_endian(head.data(), 4);
    const std::string type(reinterpret_cast<const char*>(&head[4]), 4);
    if (at + 12 + length > size) return malformed(file, "is truncated");
    std::array<unsigned char, 32> data{};
    if (length >= 4 && length <= data.size() && !fill(in, data.data(), length)) return malformed(file, "is truncated");
    const auto number = [&](int index) { return big_endian(&data[static_cast<std::size_t>(index) * 4], 4); };
    if (at == kPngMagic.size()) {
      if (type != "IHDR" || length != 13) return malformed(file, "is a malformed PNG");
      if (number(0) < 1 || number(1) < 1) return malformed(file, "has no pixels");
      if (number(0) > 0x7fffffff || number(1) > 0x7fffffff) return malformed(file, "is a malformed PNG");
      facts.size = Size{static_cast<int>(number(0)), static_cast<int>(number(1))};
      const auto area = static_cast<std::uint64_t>(facts.size->area());
      facts.least_file_bytes = area / 8 / 1100;  // a bit a pixel at least, and deflate gains 1032 at most
      const bool interlaced = data[12] != 0, deep = data[8] == 16;
      if (interlaced) facts.decoder_bytes = saturated_product({area, 4, deep ? 2u : 1u});
    } else if (type == "sRGB") {
      facts.srgb = true;
    } else if (type == "iCCP") {
      facts.icc = true;
    } else if (type == "gAMA" && length == 4 && number(0) > 0) {
      facts.gamma = number(0) / 1e5;
    } else if (type == "cHRM" && length == 32) {
      const auto xy = [&](int i) { return std::array<double, 2>{number(2 * i) / 1e5, number(2 * i + 1) / 1e5}; };
      facts.primaries = Chromaticities{xy(1), xy(2), xy(3), xy(0)};
    }
    AFTERGLOW_CHECK(check_sum(file, in, at, length));
    if (type == "IEND") return facts;
    at += 12 + length;
  }
}

bool is_frame_header(unsigned char marker) {
  return marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
}

bool is_progressive(unsigned char marker) { return (marker & 3) == 2; }

/// Walks the segments, and the entropy-coded data for its end marker.
Result<ContainerFacts> check_jpeg(const fs::path& file, std::ifstream& in, std::uint64_t size) {
  constexpr std::uint64_t kLargestFile = 1u << 30;
  if (size > kLargestFile) return malformed(file, "is larger than any JPEG should be");
  std::vector<unsigned char> bytes(size);
  in.seekg(0);
  if (!fill(in, bytes.data(), bytes.size())) return malformed(file, "cannot be read");
  ContainerFacts facts;
  facts.kind = ContainerFacts::Kind::jpeg;
  std::size_t at = 2;
  while (at + 1 < bytes.size()) {
    // Between segments and inside coded data alike: the next 0xff that is followed by a marker.
    if (bytes[at] != 0xff || bytes[at + 1] == 0xff || bytes[at + 1] == 0 ||
        (bytes[at + 1] >= 0xd0 && bytes[at + 1] <= 0xd7)) {
      const auto* next = static_cast<const unsigned char*>(std::memchr(&bytes[at + 1], 0xff, bytes.size() - at - 1));
      if (!next) break;
      at = static_cast<std::size_t>(next - bytes.data());
      continue;
    }
    const unsigned char marker = bytes[at + 1];
    if (marker == 0xd9) {
      if (!facts.size) return malformed(file, "is a malformed JPEG");
      return facts;
    }
    if (at + 4 > bytes.size()) break;
    const std::size_t length = big_endian(&bytes[at + 2], 2);
    if (length < 2 || at + 2 + length > bytes.size()) break;
    if (is_frame_header(marker)) {
      if (length < 8 || facts.size) return malformed(file, "is a malformed JPEG");
      facts.size =
          Size{static_cast<int>(big_endian(&bytes[at + 7], 2)), static_cast<int>(big_endian(&bytes[at + 5], 2))};
      if (facts.size->width < 1 || facts.size->height < 1) return malformed(file, "has no pixels");
      const auto area = static_cast<std::uint64_t>(facts.size->area());
      // Huffman codes (the first three kinds) take a bit at least for each block of 8×8.
      if (marker <= 0xc2) facts.least_file_bytes = area / 64 / 8;
      if (is_progressive(marker)) facts.decoder_bytes = area * bytes[at + 9] * sizeof(std::int16_t);
    }
    at += 2 + length;
  }
  return malformed(file, "is truncated");
}

/// OpenImageIO makes room for as many bytes of the user's data as the header claims.
Result<ContainerFacts> check_dpx(const fs::path& file, std::ifstream& in, std::uint64_t size, bool big) {
  constexpr std::uint32_t kUndefined = 0xffffffff;
  std::array<unsigned char, 4> field{};
  in.seekg(32);
  if (!fill(in, field.data(), field.size())) return malformed(file, "is truncated");
  if (!big) std::ranges::reverse(field);
  const std::uint32_t user_bytes = big_endian(field.data(), 4);
  if (user_bytes != kUndefined && user_bytes > size) return malformed(file, "is truncated");
  return ContainerFacts{};
}

}  // namespace

Result<ContainerFacts> check_container(const fs::path& file) {
  std::error_code ec;
  const fs::file_status status = fs::status(file, ec);
  if (!fs::exists(status)) {
    const bool missing = !ec || ec == std::errc::no_such_file_or_directory;
    return Error{ErrorKind::io, missing ? "no such file" : "cannot be read: " + ec.message(), file.string()};
  }
  if (fs::is_directory(status)) return malformed(file, "is a folder, not a picture");
  if (!fs::is_regular_file(status)) return malformed(file, "is not a regular file");
  const std::uint64_t size = fs::file_size(file, ec);
  if (ec) return Error{ErrorKind::io, "cannot be read: " + ec.message(), file.string()};
  if (size == 0) return malformed(file, "is empty");
  std::ifstream in(file, std::ios::binary);
  if (!in) return Error{ErrorKind::io, fmt::format("cannot be read: {}", std::strerror(errno)), file.string()};
  std::array<unsigned char, 4096> bytes{};
  in.read(reinterpret_cast<char*>(bytes.data()), bytes.size());
  const auto head = std::span<const unsigned char>(bytes).first(static_cast<std::size_t>(in.gcount()));
  in.clear();
  const auto starts_with = [&](std::string_view magic) {
    return std::string_view(reinterpret_cast<const char*>(head.data()), head.size()).starts_with(magic);
  };
  if (starts_with(kPngMagic)) return check_png(file, in, size);
  if (starts_with("\xff\xd8\xff")) return check_jpeg(file, in, size);
  if (starts_with("SDPX") || starts_with("XPDS")) return check_dpx(file, in, size, starts_with("SDPX"));
  if (starts_with("\x01\xda")) {
    AFTERGLOW_CHECK(check_sgi(file, in, size));
    return ContainerFacts{};
  }
  ContainerFacts facts;
  if (is_exr(file)) facts.kind = ContainerFacts::Kind::exr;
  if (const auto claimed = claimed_size(head)) {
    facts.size = claimed->size;
    facts.decoder_bytes =
        saturated_product({static_cast<std::uint64_t>(claimed->size.area()), claimed->bytes_per_pixel});
  }
  return facts;
}

}  // namespace afterglow
