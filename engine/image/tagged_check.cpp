// SPDX-License-Identifier: MIT
#include "image/tagged_check.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <set>
#include <string_view>
#include <vector>

#include "core/text.h"
#include "image/container_bytes.h"
#include "image/metadata_check.h"

namespace afterglow {
namespace {

constexpr std::uint64_t kMostMetadata = 16u << 20;
using Buffer = std::vector<unsigned char>;

/// As far as it can be unpacked, like libpng, which stops at 8 MB.
Buffer inflated(Bytes packed) {
  constexpr std::size_t kMost = 8'000'000, kStep = 1u << 16;
  Buffer out;
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) return out;
  stream.next_in = const_cast<unsigned char*>(packed.data());
  stream.avail_in = static_cast<uInt>(packed.size());
  for (int state = Z_OK; state == Z_OK && out.size() < kMost;) {
    const std::size_t before = out.size();
    out.resize(before + kStep);
    stream.next_out = &out[before];
    stream.avail_out = kStep;
    state = inflate(&stream, Z_NO_FLUSH);
    out.resize(before + kStep - stream.avail_out);
    if (out.size() == before) break;
  }
  inflateEnd(&stream);
  return out;
}

/// EXIF as two hexadecimal digits a byte, behind a line with its length.
const char* hex_exif_fault(Bytes text) {
  std::size_t at = 0;
  const auto skip = [&](auto is) {
    while (at < text.size() && is(text[at])) ++at;
  };
  skip([](int c) { return std::isspace(c) != 0; });
  skip([](int c) { return std::isalpha(c) != 0; });
  skip([](int c) { return std::isspace(c) != 0 || c == '+' || c == '-'; });
  skip([](int c) { return std::isdigit(c) != 0; });
  const auto value = [](int c) { return c <= '9' ? c - '0' : std::tolower(c) - 'a' + 10; };
  Buffer bytes;
  while (at + 1 < text.size())
    if (std::isxdigit(text[at]) == 0) {
      ++at;
    } else {
      bytes.push_back(static_cast<unsigned char>(value(text[at]) << 4 | value(text[at + 1])));
      at += 2;
    }
  const std::string begin(bytes.begin(),
                          bytes.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(bytes.size(), 4)));
  return lower(begin) == "exif" ? exif_fault(bytes) : nullptr;
}

const char* text_fault(const std::string& key, Bytes text) {
  if (lower(key) == "xml:com.adobe.xmp") return xmp_fault(text);
  return lower(key) == "raw profile type exif" ? hex_exif_fault(text) : nullptr;
}

}  // namespace

const char* png_metadata_fault(const std::string& type, std::ifstream& in, std::uint64_t at, std::uint64_t length,
                               ContainerFacts& facts) {
  if (type != "eXIf" && type != "iCCP" && type != "tEXt" && type != "zTXt" && type != "iTXt") return nullptr;
  if (length > kMostMetadata) return "has more than 16 MiB of metadata in one piece";
  const Buffer chunk = bytes_at(in, at, length);
  if (type == "eXIf") {
    if (!facts.orientation) facts.orientation = exif_orientation(chunk);
    return exif_fault(chunk);
  }
  const auto key_end = std::ranges::find(chunk, 0);
  const std::string key(chunk.begin(), key_end);
  Bytes rest = Bytes(chunk).subspan(std::min(chunk.size(), key.size() + 1));
  if (type == "tEXt") return text_fault(key, rest);
  if (rest.empty()) return nullptr;
  if (type == "iCCP") {
    const Buffer unpacked = inflated(rest.subspan(1));
    if (facts.profile.empty()) facts.profile = unpacked;
    return icc_fault(unpacked);
  }
  if (type == "zTXt") return text_fault(key, inflated(rest.subspan(1)));
  // iTXt: whether it is packed, how, two texts that end, the text.
  const bool packed = rest[0] != 0;
  rest = rest.subspan(std::min<std::size_t>(rest.size(), 2));
  for (int skipped = 0; skipped < 2; ++skipped) {
    const auto end = static_cast<std::size_t>(std::ranges::find(rest, 0) - rest.begin());
    rest = rest.subspan(std::min(rest.size(), end + 1));
  }
  return packed ? text_fault(key, inflated(rest)) : text_fault(key, rest);
}

Result<void> check_webp(const std::filesystem::path& file, std::ifstream& in, std::uint64_t size,
                        ContainerFacts& facts) {
  constexpr std::size_t kName = 6;  // "Exif\0\0", which some programs write: the reader skips it, whatever it is
  for (std::uint64_t at = 12; at + 8 <= size;) {
    const Buffer head = bytes_at(in, at, 8);
    if (head.size() < 8) break;
    const std::uint64_t length = little_endian(&head[4], 4);
    const std::string_view type(reinterpret_cast<const char*>(head.data()), 4);
    if ((type == "EXIF" || type == "ICCP") && length > kMostMetadata)
      return malformed(file, "has more than 16 MiB of metadata in one piece");
    if (type == "ICCP" && facts.profile.empty()) facts.profile = bytes_at(in, at + 8, length);
    if (type == "EXIF") {
      const Buffer chunk = bytes_at(in, at + 8, length);
      const Bytes behind = Bytes(chunk).subspan(std::min(chunk.size(), kName));
      for (const Bytes bytes : {behind, Bytes(chunk)})  // as the reader takes it, and as it is
        if (const char* why = exif_fault(bytes)) return malformed(file, why);
      facts.orientation = exif_orientation(chunk);
      facts.exif = chunk;
    }
    at += 8 + length + (length & 1);
  }
  return {};
}

Result<void> check_tiff(const std::filesystem::path& file, std::ifstream& in, std::uint64_t size) {
  constexpr int kMostPages = 64;
  constexpr std::uint32_t kXmp = 700, kProfile = 34675, kBits = 258;
  constexpr std::uint32_t kKind = 254, kInner = 330, kDng = 50706;
  const Buffer head = bytes_at(in, 0, 16);
  if (head.size() < 8) return malformed(file, "is truncated");
  const bool big = head[0] == 'M', large = (big ? head[3] : head[2]) == 43;
  if (large && head.size() < 16) return malformed(file, "is truncated");
  const auto number = [&](const unsigned char* p, std::size_t bytes) { return ordered(p, bytes, big); };
  const std::size_t wide = large ? 8 : 4, entry = large ? 20 : 12, counter = large ? 8 : 2;
  std::set<std::uint64_t> seen;
  std::uint64_t at = number(&head[large ? 8 : 4], wide);
  for (int page = 0; page < kMostPages && at != 0 && at < size && seen.insert(at).second; ++page) {
    const Buffer counted = bytes_at(in, at, counter);
    if (counted.size() < counter) break;
    const std::uint64_t entries = number(counted.data(), counter);
    if (entries > (size - at) / entry) break;
    const Buffer table = bytes_at(in, at + counter, entries * entry + wide);
    std::map<std::uint64_t, std::uint64_t> said;  // tag → its value, as far as it is one number
    for (std::size_t i = 0; (i + 1) * entry <= table.size(); ++i) {
      const unsigned char* p = &table[i * entry];
      const std::uint64_t tag = number(p, 2), length = number(p + 4, wide), place = number(p + 4 + wide, wide);
      constexpr std::uint64_t kShort = 3;
      said[tag] = number(p + 2, 2) == kShort ? number(p + 4 + wide, 2) : place;
      if ((tag != kXmp && tag != kProfile) || length <= wide || place >= size) continue;
      if (length > kMostMetadata) return malformed(file, "has more than 16 MiB of metadata in one piece");
      const Buffer bytes = bytes_at(in, place, length);
      if (const char* why = tag == kXmp ? xmp_fault(bytes) : icc_fault(bytes)) return malformed(file, why);
    }
    // What a camera saw lies within; the first picture is a small one, to be shown in its place.
    const bool small = said.contains(kKind) && (said[kKind] & 1) != 0;
    if (page == 0 && (said.contains(kDng) || (small && said.contains(kInner))))
      return malformed(file, "is a camera raw, which has to be developed first; take the TIFF or EXR made of it");
    // Then a sample is one bit, and the reader takes it for eight.
    if (page == 0 && entries > 0 && !said.contains(kBits))
      return malformed(file, "does not say how many bits a sample has (BitsPerSample), which the reader needs");
    if (table.size() < entries * entry + wide) break;
    at = number(&table[entries * entry], wide);
  }
  return {};
}

}  // namespace afterglow
