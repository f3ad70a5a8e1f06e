// SPDX-License-Identifier: MIT
#include "image/container_end.h"

#include <algorithm>
#include <array>
#include <optional>

#include "image/container_bytes.h"

namespace afterglow {
namespace {

using namespace std::string_view_literals;

/// How many bytes a part takes; nothing: nobody knows, or what follows does not matter.
using Length = std::optional<std::uint64_t>;
constexpr std::uint64_t kBeyond = ~0ull;  // longer than the file

const unsigned char* codes(std::string_view text) { return reinterpret_cast<const unsigned char*>(text.data()); }
std::uint64_t high_first(std::string_view head, std::size_t at, std::size_t count) {
  return ordered(codes(head) + at, count, true);
}
std::uint64_t low_first(std::string_view head, std::size_t at, std::size_t count) {
  return ordered(codes(head) + at, count, false);
}
int code(std::string_view head, std::size_t at) { return codes(head)[at]; }

// The length of a part by its head, which is shorter than asked for at the end of the file.

Length ivf_part(std::string_view head) {
  if (head.size() < 12) return kBeyond;
  return head.starts_with("DKIF"sv) ? low_first(head, 6, 2) : 12 + low_first(head, 0, 4);
}

/// The size of the tag before, then a tag. Behind the last tag its size stands alone.
Length flv_part(std::string_view head) {
  if (head.starts_with("FLV"sv)) return head.size() < 9 ? kBeyond : high_first(head, 5, 4);
  if (head.size() <= 4) return head.size();
  constexpr int kSound = 8, kVideo = 9, kScript = 18, kKinds = 31;
  const int kind = code(head, 4) & kKinds;
  if (kind != kSound && kind != kVideo && kind != kScript) return std::nullopt;
  return head.size() < 15 ? kBeyond : 15 + high_first(head, 5, 3);
}

/// MPEG program streams: packs, and packets that say how long they are.
Length mpeg_part(std::string_view head) {
  if (!"\0\0\1"sv.starts_with(head.substr(0, 3))) return std::nullopt;
  if (head.size() < 4) return kBeyond;
  constexpr int kEnd = 0xb9, kPack = 0xba, kLeast = 0xbb, kTwo = 1;
  const int kind = code(head, 3);
  if (kind == kEnd) return 4;
  if (kind == kPack && head.size() < 14) return kBeyond;
  if (kind == kPack) return code(head, 4) >> 6 == kTwo ? 14 + (code(head, 13) & 7) : 12;
  if (kind < kLeast) return std::nullopt;
  return head.size() < 6 ? kBeyond : 6 + high_first(head, 4, 2);
}

Length png_part(std::string_view head) {
  if (head.starts_with("\x89PNG"sv)) return 8;
  if (head.size() < 8) return kBeyond;
  return head.substr(4, 4) == "IEND"sv ? std::nullopt : Length(12 + high_first(head, 0, 4));
}

/// Key, length, value.
Length mxf_part(std::string_view head) {
  constexpr std::size_t kKey = 16;
  if (!head.starts_with("\x06\x0e\x2b\x34"sv)) return std::nullopt;
  if (head.size() <= kKey) return kBeyond;
  const int first = code(head, kKey);
  if (first < 0x80) return kKey + 1 + static_cast<unsigned>(first);
  const auto digits = static_cast<std::size_t>(first & 0x7f);
  if (digits < 1 || digits > 8) return std::nullopt;
  return head.size() < kKey + 1 + digits ? kBeyond : kKey + 1 + digits + high_first(head, kKey + 1, digits);
}

/// Objects with names; those of a file that was written to a pipe do not say how long the data are.
Length asf_part(std::string_view head) {
  constexpr std::uint64_t kHead = 24;
  constexpr std::array kObjects{"\x30\x26\xb2\x75"sv, "\x36\x26\xb2\x75"sv, "\x90\x08\0\x33"sv,
                                "\xd3\x29\xe2\xd6"sv};  // header, data, two kinds of index
  if (std::ranges::none_of(kObjects, [&](std::string_view name) { return head.starts_with(name); }))
    return std::nullopt;
  if (head.size() < kHead) return kBeyond;
  const std::uint64_t size = low_first(head, 16, 8);
  return size > kHead ? Length(size) : std::nullopt;
}

Length ogg_page(std::string_view head) {
  constexpr std::size_t kHead = 27;
  if (!"OggS"sv.starts_with(head.substr(0, 4))) return std::nullopt;
  if (head.size() < kHead) return kBeyond;
  const auto segments = static_cast<std::size_t>(code(head, kHead - 1));
  if (head.size() < kHead + segments) return kBeyond;
  std::uint64_t length = kHead + segments;
  for (std::size_t i = 0; i < segments; ++i) length += static_cast<unsigned>(code(head, kHead + i));
  return length;
}

/// The head of Matroska, and its one segment: a number of bytes by the zeros in front, all ones for not known.
Length matroska_part(std::string_view head) {
  if (!head.starts_with("\x1a\x45\xdf\xa3"sv) && !head.starts_with("\x18\x53\x80\x67"sv)) return std::nullopt;
  constexpr std::size_t kName = 4;
  if (head.size() <= kName) return kBeyond;
  std::size_t digits = 1;
  while (digits <= 8 && (code(head, kName) >> (8 - digits) & 1) == 0) ++digits;
  if (digits > 8) return std::nullopt;
  if (head.size() < kName + digits) return kBeyond;
  const std::uint64_t mask = (std::uint64_t{1} << 7 * digits) - 1, size = high_first(head, kName, digits) & mask;
  return size == mask ? std::nullopt : Length(kName + digits + size);
}

/// AVI: one list of all, or several; of what was written to a pipe the size is not known.
Length riff_part(std::string_view head) {
  constexpr std::uint64_t kUnknown = 0xffffffff;
  if (head.size() < 12) return head.starts_with("RIFF"sv) ? Length(kBeyond) : std::nullopt;
  const std::uint64_t size = low_first(head, 4, 4);
  if (!head.starts_with("RIFF"sv) || !head.substr(8).starts_with("AVI"sv) || size == 0 || size == kUnknown)
    return std::nullopt;
  return 8 + size;
}

struct Container {
  std::string_view format;
  std::size_t head;  ///< bytes that tell a part's length
  Length (*length)(std::string_view head);
};
constexpr std::array kContainers{
    Container{"ivf"sv, 12, ivf_part},  Container{"flv"sv, 15, flv_part},  Container{"mpeg"sv, 14, mpeg_part},
    Container{"apng"sv, 8, png_part},  Container{"mxf"sv, 25, mxf_part},  Container{"asf"sv, 24, asf_part},
    Container{"avi"sv, 12, riff_part}, Container{"ogg"sv, 282, ogg_page}, Container{"matroska"sv, 12, matroska_part}};

bool ends_in_a_part(const Container& container, const PlacedBytes& bytes) {
  for (std::uint64_t at = 0; at < bytes.size;) {
    const std::uint64_t left = bytes.size - at;
    const std::string_view head = bytes.look(at, container.head);
    if (head.size() < std::min<std::uint64_t>(container.head, left)) return false;  // it was not kept
    const Length length = container.length(head);
    if (!length || *length == 0) return false;
    if (*length > left) return true;
    at += *length;
  }
  return false;
}

/// Images and extensions, each with blocks of up to 255 bytes behind it; the last byte is a mark.
bool gif_ends_early(const PlacedBytes& bytes) {
  constexpr int kImage = 0x2c, kExtension = 0x21, kNone = -1;
  std::uint64_t at = 10;
  const auto byte = [&] {
    const std::string_view one = bytes.look(at++, 1);
    return one.empty() ? kNone : code(one, 0);
  };
  const auto skip_table = [&](int flags) { at += (flags & 0x80) != 0 ? 3u << ((flags & 7) + 1) : 0; };
  skip_table(byte());
  at += 2;
  while (at < bytes.size) {
    const int kind = byte();
    if (kind != kImage && kind != kExtension) return false;
    if (kind == kImage) {
      at += 8;
      skip_table(byte());
    }
    ++at;
    int size = byte();
    for (; size > 0; size = byte()) at += static_cast<unsigned>(size);
    if (size == kNone) return true;
  }
  return at > bytes.size;
}

/// NUT ends with an index, which says how long it is. (One that was written without it cannot be told from a cut one.)
bool nut_ends_early(const PlacedBytes& bytes) {
  constexpr std::size_t kFoot = 12;  // the length, a sum
  if (bytes.size < kFoot) return true;
  const std::string_view foot = bytes.look(bytes.size - kFoot, kFoot);
  if (foot.size() < kFoot) return false;
  const std::uint64_t length = high_first(foot, 0, 8);
  if (length < kFoot || length > bytes.size) return true;
  const std::string_view name = bytes.look(bytes.size - length, 8);
  return name.size() == 8 && name != "NX\xdd\x67\x2f\x23\xe6\x4e"sv;
}

/// Packets of one length, each with a mark.
bool transport_ends_early(const PlacedBytes& bytes) {
  for (const auto& [mark, packet] : {std::pair{0u, 188u}, std::pair{4u, 192u}}) {
    const std::uint64_t left = bytes.size % packet;
    const std::string_view last =
        bytes.size < 2 * packet + left ? "" : bytes.look(bytes.size - left - 2 * packet, 2 * packet);
    if (last.size() == 2 * packet && last[mark] == 'G' && last[packet + mark] == 'G') return left > 0;
  }
  return false;
}

/// JPEGs one behind the other: the last one has its end.
bool jpegs_end_early(const PlacedBytes& bytes) {
  return bytes.size < 2 || bytes.look(bytes.size - 2, 2) != "\xff\xd9"sv;
}

}  // namespace

bool ends_early(std::string_view format, const PlacedBytes& bytes, std::uint64_t last) {
  const auto* container = std::ranges::find(kContainers, format, &Container::format);
  if (container != kContainers.end()) return ends_in_a_part(*container, bytes);
  if (format == "yuv4mpegpipe") return last > 0 && last < bytes.size;
  if (format == "gif") return gif_ends_early(bytes);
  if (format == "mjpeg") return jpegs_end_early(bytes);
  if (format == "nut") return nut_ends_early(bytes);
  return format == "mpegts" && transport_ends_early(bytes);
}

}  // namespace afterglow
