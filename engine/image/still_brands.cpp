// SPDX-License-Identifier: MIT
#include "image/still_brands.h"

#include <algorithm>
#include <array>

#include "image/container_bytes.h"

namespace afterglow {
namespace {

using namespace std::string_view_literals;

Still still_of_brand(std::string_view brand) {
  constexpr std::array kHeif{"avif"sv, "avci"sv, "heic"sv, "heix"sv, "heim"sv, "heis"sv, "mif1"sv, "mif2"sv};
  constexpr std::array kOther{"jxl "sv, "jp2 "sv, "crx "sv};
  if (std::ranges::find(kHeif, brand) != kHeif.end()) return Still::heif;
  return std::ranges::find(kOther, brand) != kOther.end() ? Still::other : Still::none;
}

/// Sequences of such pictures, and videos whose files say that they hold one picture besides.
bool is_moving(std::string_view brand) {
  for (const std::string_view moving : {"avis"sv, "msf1"sv, "hevc"sv, "hevx"sv, "iso"sv, "mp4"sv, "qt"sv, "M4V"sv})
    if (brand.starts_with(moving)) return true;
  return false;
}

}  // namespace

Still still_of(std::string_view head) {
  constexpr std::size_t kMajor = 8, kCompatible = 16, kBrand = 4;
  if (head.size() < kMajor + kBrand || head.substr(4, 4) != "ftyp") return Still::none;
  const std::size_t size = big_endian(reinterpret_cast<const unsigned char*>(head.data()), 4);
  const std::string_view major = head.substr(kMajor, kBrand);
  if (const Still still = still_of_brand(major); still != Still::none || is_moving(major)) return still;
  for (std::size_t at = kCompatible; at + kBrand <= std::min(size, head.size()); at += kBrand)
    if (const Still still = still_of_brand(head.substr(at, kBrand)); still != Still::none) return still;
  return Still::none;
}

}  // namespace afterglow
