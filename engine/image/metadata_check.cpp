// SPDX-License-Identifier: MIT
#include "image/metadata_check.h"

#include <algorithm>
#include <cstdint>
#include <set>
#include <string_view>

#include "image/container_bytes.h"

namespace afterglow {
namespace {

constexpr const char* kExif = "is damaged: its EXIF metadata";
constexpr const char* kIcc = "is damaged: its ICC profile";
constexpr std::size_t kMostExif = 1u << 20;  ///< arrays of it go onto the stack
constexpr int kDeepest = 8;                  ///< directories in directories
constexpr int kDeepestXml = 256;

std::string_view text_of(Bytes bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

/// From the TIFF head on.
Bytes behind_name(Bytes exif) {
  constexpr std::string_view kName("Exif\0\0", 6);
  return text_of(exif).starts_with(kName) ? exif.subspan(kName.size()) : exif;
}

/// Whether it begins as TIFF does, with the order of its bytes.
bool says_order(Bytes exif) { return text_of(exif).starts_with("II") || text_of(exif).starts_with("MM"); }

/// Directories of EXIF, as deep as they go.
class Exif {
 public:
  explicit Exif(Bytes bytes) : bytes_(bytes), little_(bytes[0] == 'I') {}

  bool sound() {
    const std::uint64_t first = number(4, 4);
    return first + 2 > bytes_.size() || directory(first, 0);
  }

  /// Of the first directory; none: it says none, or one that there is not.
  std::optional<int> orientation() const {
    constexpr std::uint32_t kTag = 0x0112, kShort = 3;
    const auto entry = entry_of(number(4, 4), kTag, kShort);
    if (!entry) return std::nullopt;
    const std::uint32_t value = number(*entry + 8, 2);
    return value >= 1 && value <= 8 ? std::optional(static_cast<int>(value)) : std::nullopt;
  }

  /// By the index of the directory of interoperability, which lies in that of EXIF.
  bool says_adobe_rgb() const {
    constexpr std::uint32_t kDirectory = 0x8769, kInterop = 0xa005, kIndex = 1, kText = 2, kLong = 4;
    constexpr std::uint32_t kSpace = 0xa001, kShort = 3, kSrgb = 1;
    const auto exif = entry_of(number(4, 4), kDirectory, kLong);
    const auto space = exif ? entry_of(number(*exif + 8, 4), kSpace, kShort) : std::nullopt;
    if (space && number(*space + 8, 2) == kSrgb) return false;
    const auto interop = exif ? entry_of(number(*exif + 8, 4), kInterop, kLong) : std::nullopt;
    const auto index = interop ? entry_of(number(*interop + 8, 4), kIndex, kText) : std::nullopt;
    return index && text_of(bytes_).substr(*index + 8, 3) == "R03";
  }

 private:
  static constexpr std::uint64_t kEntry = 12;  // bytes

  std::uint32_t number(std::size_t at, std::size_t bytes) const {
    return static_cast<std::uint32_t>(ordered(&bytes_[at], bytes, !little_));
  }

  /// Where a directory's entry with that tag and type begins, which lies wholly within the bytes.
  std::optional<std::uint64_t> entry_of(std::uint64_t directory, std::uint32_t tag, std::uint32_t type) const {
    if (directory + 2 > bytes_.size()) return std::nullopt;
    const std::uint32_t count = number(directory, 2);
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::uint64_t entry = directory + 2 + i * kEntry;
      if (entry + kEntry > bytes_.size()) break;
      if (number(entry, 2) == tag && number(entry + 2, 2) == type) return entry;
    }
    return std::nullopt;
  }

  bool directory(std::uint64_t at, int depth) {
    constexpr std::uint32_t kShort = 3, kLong = 4, kRational = 5, kSigned = 10;
    if (depth > kDeepest || at + 2 > bytes_.size()) return false;
    if (!seen_.insert(at).second) return true;
    const std::uint32_t count = number(at, 2);
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::uint64_t entry = at + 2 + i * kEntry;
      if (entry + kEntry > bytes_.size()) break;
      const std::uint32_t tag = number(entry, 2), type = number(entry + 2, 2), values = number(entry + 4, 4);
      const bool inner = tag == 0x8769 || tag == 0x8825 || tag == 0xa005;  // EXIF, GPS, interoperability
      if (inner) {
        const std::uint64_t offset = number(entry + 8, 4);
        if (offset < bytes_.size() && !directory(offset, depth + 1)) return false;
      } else if (values == 0 && (type == kShort || type == kLong || type == kRational || type == kSigned)) {
        return false;
      }
    }
    return true;
  }

  Bytes bytes_;
  bool little_;
  std::set<std::uint64_t> seen_;
};

/// The end of a tag that begins at `at`: behind its '>', quotation marks heeded.
std::size_t tag_end(std::string_view xml, std::size_t at) {
  char quote = 0;
  for (; at < xml.size(); ++at) {
    const char c = xml[at];
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '>') {
      return at + 1;
    }
  }
  return xml.size();
}

}  // namespace

const char* exif_fault(Bytes exif) {
  exif = behind_name(exif);
  if (exif.size() < 8) return kExif;
  if (exif.size() > kMostExif) return "has more than 1 MiB of EXIF metadata";
  if (!says_order(exif)) return nullptr;
  return Exif(exif).sound() ? nullptr : kExif;
}

std::optional<int> exif_orientation(Bytes exif) {
  exif = behind_name(exif);
  return exif.size() >= 8 && says_order(exif) ? Exif(exif).orientation() : std::nullopt;
}

bool exif_says_adobe_rgb(Bytes exif) {
  exif = behind_name(exif);
  return exif.size() >= 8 && says_order(exif) && Exif(exif).says_adobe_rgb();
}

const char* icc_fault(Bytes profile) {
  constexpr std::size_t kHeader = 128, kEntry = 12, kRecord = 12;
  if (profile.size() < kHeader + 4 || text_of(profile).substr(36, 4) != "acsp") return nullptr;
  if (big_endian(profile.data(), 4) != profile.size()) return nullptr;
  const std::uint32_t count = big_endian(&profile[kHeader], 4);
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t entry = kHeader + 4 + i * kEntry;
    if (entry + kEntry > profile.size()) break;
    const std::uint64_t offset = big_endian(&profile[entry + 4], 4), size = big_endian(&profile[entry + 8], 4);
    if (offset + size > profile.size() || offset + 4 > profile.size()) return kIcc;
    const std::string_view type = text_of(profile).substr(offset, 4);
    if ((type == "text" && size < 8) || (type == "desc" && size < 12)) return kIcc;
    if (type != "mluc" || offset + 16 > profile.size()) continue;
    const std::uint32_t records = big_endian(&profile[offset + 8], 4);
    for (std::uint64_t r = 0; r < records; ++r) {
      const std::uint64_t record = offset + 16 + r * kRecord;
      if (record + kRecord > profile.size()) break;
      const std::uint64_t length = big_endian(&profile[record + 4], 4), at = big_endian(&profile[record + 8], 4);
      if (text_of(profile).substr(record, 2) == "en" && offset + at + length > profile.size()) return kIcc;
    }
  }
  return nullptr;
}

const char* xmp_fault(Bytes xml) {
  const std::string_view text = text_of(xml);
  const auto behind = [&](std::size_t at, std::string_view end) {
    const std::size_t found = text.find(end, at);
    return found == text.npos ? text.size() : found + end.size();
  };
  int depth = 0;
  for (std::size_t at = text.find('<'); at < text.size(); at = text.find('<', at)) {
    const std::string_view rest = text.substr(at);
    if (rest.starts_with("<!--")) {
      at = behind(at, "-->");
    } else if (rest.starts_with("<![CDATA[")) {
      at = behind(at, "]]>");
    } else if (rest.starts_with("<?")) {
      at = behind(at, "?>");
    } else if (rest.starts_with("<!")) {
      at = tag_end(text, at);
    } else {
      const std::size_t end = tag_end(text, at);
      const bool closes = rest.starts_with("</"), alone = end >= 2 && text[end - 2] == '/';
      depth = closes ? std::max(0, depth - 1) : depth + (alone ? 0 : 1);
      if (depth > kDeepestXml) return "is damaged: its XMP metadata is nested too deeply";
      at = end;
    }
  }
  return nullptr;
}

}  // namespace afterglow
