// SPDX-License-Identifier: MIT
#include "image/several_pictures.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "image/container_bytes.h"

namespace afterglow {
namespace {

using namespace std::string_view_literals;

std::uint64_t number(std::string_view bytes, std::size_t at, std::size_t count, bool highest_first) {
  return ordered(reinterpret_cast<const unsigned char*>(bytes.data()) + at, count, highest_first);
}

/// Whether a file of the same kind begins where the first one says that it ends.
bool begins_at(std::string_view bytes, std::uint64_t end, std::string_view signature) {
  return end > 0 && end < bytes.size() && bytes.substr(end).starts_with(signature);
}

bool has_again(std::string_view bytes, std::string_view mark) {
  return bytes.find(mark, mark.size()) != std::string_view::npos;
}

/// The mark, version 2, and flags of which only some have a meaning.
bool several_exr(std::string_view bytes) {
  constexpr std::string_view kMark = "\x76\x2f\x31\x01\x02"sv;
  constexpr int kFlags = 0x1e;
  for (std::size_t at = kMark.size(); (at = bytes.find(kMark, at)) != std::string_view::npos; ++at)
    if (at + 8 <= bytes.size() && (number(bytes, at + 5, 1, true) & ~kFlags) == 0 &&
        number(bytes, at + 6, 2, true) == 0)
      return true;
  return false;
}

/// A directory with tags in their order, among them the sides of a picture and where its pixels are: makers' notes,
/// which have the same mark in front, have none of those.
bool is_tiff(std::string_view bytes) {
  const bool big = bytes[0] == 'M';
  constexpr std::size_t kHead = 8, kEntry = 12;
  if (bytes.size() < kHead) return false;
  const std::uint64_t directory = number(bytes, 4, 4, big);
  if (directory < kHead || directory + 2 > bytes.size()) return false;
  const std::uint64_t entries = number(bytes, directory, 2, big);
  if (directory + 2 + entries * kEntry > bytes.size()) return false;
  constexpr std::uint64_t kWidth = 256, kHeight = 257, kStrips = 273, kTiles = 324;
  int needed = 0;
  std::uint64_t before = 0;
  for (std::uint64_t i = 0; i < entries; ++i) {
    const std::uint64_t tag = number(bytes, directory + 2 + i * kEntry, 2, big);
    if (tag <= before) return false;
    before = tag;
    needed += tag == kWidth || tag == kHeight || tag == kStrips || tag == kTiles ? 1 : 0;
  }
  return needed >= 3;
}

bool several_tiff(std::string_view bytes) {
  const std::string_view mark = bytes.substr(0, 4);
  for (std::size_t at = mark.size(); (at = bytes.find(mark, at)) != std::string_view::npos; ++at)
    if (is_tiff(bytes.substr(at))) return true;
  return false;
}

/// Segments to the end of the picture, as in jpeg_check.cpp.
std::optional<FirstOfSeveral> several_jpeg(std::string_view bytes) {
  FirstOfSeveral first{.kind = "JPEG", .video = "mjpeg"};
  std::size_t at = 2;
  while (at + 1 < bytes.size()) {
    const auto marker = static_cast<int>(number(bytes, at + 1, 1, true));
    const bool filling = marker == 0xff || marker == 0 || (marker >= 0xd0 && marker <= 0xd7);
    if (bytes[at] != '\xff' || filling) {
      at = std::min(bytes.find('\xff', at + 1), bytes.size());
      continue;
    }
    if (marker == 0xd9) {
      if (!begins_at(bytes, at + 2, "\xff\xd8\xff"sv)) return std::nullopt;
      return first;
    }
    if (at + 4 > bytes.size()) return std::nullopt;
    const std::string_view segment = bytes.substr(at + 4);
    if (marker == 0xe2 && segment.starts_with("MPF\0"sv)) return std::nullopt;
    if (marker == 0xe2 && segment.starts_with("ICC_PROFILE\0"sv)) first.leaves = "colour profile";
    at += 2 + number(bytes, at + 2, 2, true);
  }
  return std::nullopt;
}

/// A kind whose header says how long the file is.
struct OfLength {
  std::string_view signature, name;
  std::size_t at;  ///< where the four bytes of the length are
  bool big = false;
  std::uint64_t more = 0;  ///< bytes that the length does not count
};
constexpr std::array kOfLength{
    OfLength{"BM"sv, "BMP", 2},
    OfLength{"SDPX"sv, "DPX", 16, true},
    OfLength{"XPDS"sv, "DPX", 16},
    OfLength{"\x80\x2a\x5f\xd7"sv, "Cineon", 20, true},
    OfLength{"\xd7\x5f\x2a\x80"sv, "Cineon", 20},
    OfLength{"RIFF"sv, "WebP", 4, false, 8},
};

}  // namespace

std::optional<FirstOfSeveral> first_of_several(std::string_view bytes) {
  if (bytes.starts_with("\xff\xd8\xff"sv)) return several_jpeg(bytes);
  const auto if_so = [](bool several, std::string_view kind) {
    return several ? std::optional(FirstOfSeveral{.kind = kind}) : std::nullopt;
  };
  if (bytes.starts_with("\x89PNG"sv))
    return if_so(bytes.find("IEND\xae\x42\x60\x82\x89PNG"sv) != std::string_view::npos, "PNG");
  if (bytes.starts_with("\x76\x2f\x31\x01"sv)) return if_so(several_exr(bytes), "EXR");
  if (bytes.starts_with("II*\0"sv) || bytes.starts_with("MM\0*"sv)) return if_so(several_tiff(bytes), "TIFF");
  if (bytes.starts_with("#?RADIANCE\n"sv)) return if_so(has_again(bytes, "#?RADIANCE\n"sv), "HDR");
  constexpr std::string_view kBox = "\0\0\0\x0cjP  \r\n\x87\n"sv, kCodes = "\xff\x4f\xff\x51"sv;
  if (bytes.starts_with(kBox)) return if_so(has_again(bytes, kBox), "JPEG 2000");
  if (bytes.starts_with(kCodes))
    return if_so(bytes.find("\xff\xd9\xff\x4f\xff\x51"sv) != std::string_view::npos, "JPEG 2000");
  for (const OfLength& kind : kOfLength) {
    if (!bytes.starts_with(kind.signature) || bytes.size() < kind.at + 4) continue;
    return if_so(begins_at(bytes, kind.more + number(bytes, kind.at, 4, kind.big), kind.signature), kind.name);
  }
  return std::nullopt;
}

}  // namespace afterglow
