// SPDX-License-Identifier: MIT
#include "image/jpeg_check.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "image/container_bytes.h"
#include "image/metadata_check.h"

namespace afterglow {
namespace {

/// Metadata of a JPEG: each piece in a segment of its own, a colour profile in several.
class JpegMetadata {
 public:
  /// What is wrong with a segment, behind its length; null when nothing is.
  const char* add(unsigned char marker, Bytes segment) {
    const std::string_view text(reinterpret_cast<const char*>(segment.data()), segment.size());
    const auto begins = [&](std::string_view with) {
      return text.substr(0, with.size() + 1) == std::string(with) + '\0';
    };
    constexpr std::string_view kExifName = "Exif", kProfile = "ICC_PROFILE", kXmp = "http://ns.adobe.com/xap/1.0/",
                               kPhotoshop = "Photoshop 3.0";
    constexpr std::size_t kProfileHead = 14;
    if (marker == 0xe1 && begins(kExifName)) {
      const Bytes exif = segment.subspan(std::min<std::size_t>(segment.size(), 6));
      adobe_rgb_ = adobe_rgb_ || exif_says_adobe_rgb(exif);
      return exif_fault(exif);
    }
    if (marker == 0xe1 && begins(kXmp)) return xmp_fault(segment);
    if (marker == 0xed && begins(kPhotoshop)) return iptc_fault(segment.subspan(kPhotoshop.size() + 1));
    if (marker == 0xe2 && begins(kProfile)) {
      if (segment.size() < kProfileHead) return "is damaged: its ICC profile";
      profile_[segment[12]] = segment.subspan(kProfileHead);
    }
    return nullptr;
  }

  bool adobe_rgb() const { return adobe_rgb_; }

  /// What is wrong with the profile, when all have been added.
  const char* profile_fault() const {
    std::vector<unsigned char> whole;
    for (const auto& [number, part] : profile_) whole.insert(whole.end(), part.begin(), part.end());
    return icc_fault(whole);
  }

 private:
  /// "8BIM", 0x0404, four bytes, the length: OpenImageIO takes it for true.
  static const char* iptc_fault(Bytes block) {
    constexpr std::size_t kHead = 12;
    constexpr const char* kFault = "is damaged: its IPTC metadata";
    const std::string_view text(reinterpret_cast<const char*>(block.data()), block.size());
    if (!text.starts_with("8BIM")) return text.size() < 4 ? kFault : nullptr;
    if (block.size() < 6) return kFault;
    if (big_endian(&block[4], 2) != 0x0404) return nullptr;
    return block.size() < kHead || kHead + big_endian(&block[10], 2) > block.size() ? kFault : nullptr;
  }

  std::map<int, Bytes> profile_;  ///< by number
  bool adobe_rgb_ = false;        ///< EXIF says so
};

bool is_frame_header(unsigned char marker) {
  return marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
}

bool is_progressive(unsigned char marker) { return (marker & 3) == 2; }

}  // namespace

Result<ContainerFacts> check_jpeg(const std::filesystem::path& file, std::ifstream& in, std::uint64_t size) {
  constexpr std::uint64_t kLargestFile = 1u << 30;
  if (size > kLargestFile) return malformed(file, "is larger than any JPEG should be");
  std::vector<unsigned char> bytes(size);
  in.seekg(0);
  if (!fill(in, bytes.data(), bytes.size())) return malformed(file, "cannot be read");
  ContainerFacts facts;
  facts.kind = ContainerFacts::Kind::jpeg;
  JpegMetadata metadata;
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
      if (const char* why = metadata.profile_fault()) return malformed(file, why);
      facts.adobe_rgb = metadata.adobe_rgb();
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
    if (const char* why = metadata.add(marker, Bytes(bytes).subspan(at + 4, length - 2))) return malformed(file, why);
    at += 2 + length;
  }
  return malformed(file, "is truncated");
}

}  // namespace afterglow
