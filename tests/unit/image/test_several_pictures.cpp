// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <string>

#include "image/several_pictures.h"

namespace afterglow {
namespace {

using namespace std::string_literals;

std::string padded(std::string text, std::size_t size) {
  text.resize(size, 'x');
  return text;
}
std::string kind_of(const std::string& bytes) {
  const auto several = first_of_several(bytes);
  return several ? std::string(several->kind) : "";
}
/// Where a TIFF's sides and pixels are, as a directory at byte 8.
std::string tiff(const std::string& tags) {
  std::string text = "II*\0\x08\0\0\0"s + static_cast<char>(tags.size() / 2) + '\0';
  for (std::size_t i = 0; i < tags.size(); i += 2) text += tags.substr(i, 2) + std::string(10, '\1');
  return text;
}
const std::string kSegment = "\xff\xe0\0\4ab"s, kProfile = "\xff\xe2\0\x0eICC_PROFILE\0"s,
                  kOthers = "\xff\xe2\0\6MPF\0"s;
std::string jpeg(const std::string& segments) {
  return "\xff\xd8"s + segments + "\xff\xda\0\2data\xff\0\xff\xd0\xff\xd9"s;
}

TEST(SeveralPictures, OfEachKindAreKnown) {
  const std::string tags = "\0\1\1\1\x11\1"s;
  for (const auto& [kind, one] : {std::pair<std::string, std::string>{"PNG", "\x89PNG....IEND\xae\x42\x60\x82"},
                                  {"EXR", padded("\x76\x2f\x31\x01\2\0\0\0"s, 40)},
                                  {"TIFF", tiff(tags)},
                                  {"BMP", padded("BM\x28\0\0\0"s, 40)},
                                  {"DPX", padded("SDPX            \0\0\0\x28"s, 40)},
                                  {"DPX", padded("XPDS            \x28\0\0\0"s, 40)},
                                  {"Cineon", padded("\x80\x2a\x5f\xd7                \0\0\0\x28"s, 40)},
                                  {"HDR", padded("#?RADIANCE\n", 40)},
                                  {"WebP", padded("RIFF\x20\0\0\0WEBP"s, 40)},
                                  {"JPEG 2000", padded("\xff\x4f\xff\x51"s, 40) + "\xff\xd9"},
                                  {"JPEG", jpeg(kSegment)}}) {
    EXPECT_EQ(kind_of(one + one), kind);
    EXPECT_EQ(kind_of(one), "") << kind;
    EXPECT_EQ(kind_of(one + "more"), "") << kind;
    for (std::size_t size = 0; size <= one.size(); ++size) EXPECT_EQ(kind_of((one + one).substr(0, size)), "") << kind;
  }
  // A maker's note has a TIFF's mark, and other tags.
  EXPECT_EQ(kind_of(tiff(tags) + tiff("\1\0\2\0\3\0"s)), "");
}

TEST(SeveralPictures, JpegsAreAVideoUnlessTheyBelongTogether) {
  const auto several = first_of_several(jpeg(kSegment) + jpeg(kSegment));
  ASSERT_TRUE(several);
  EXPECT_EQ(several->video, "mjpeg");
  EXPECT_EQ(several->leaves, "");
  EXPECT_EQ(first_of_several(jpeg(kProfile) + jpeg(kProfile))->leaves, "colour profile");
  EXPECT_FALSE(first_of_several(jpeg(kOthers) + jpeg(kSegment)));
}

}  // namespace
}  // namespace afterglow
