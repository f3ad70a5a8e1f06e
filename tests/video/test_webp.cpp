// SPDX-License-Identifier: MIT
// Animated WebP: frames, times, alpha, damage.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <lcms2.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "clips.h"
#include "core/file.h"
#include "image/container_bytes.h"

namespace afterglow {
namespace {

using testing::HasSubstr, testing::IsEmpty;

/// Rec.709, a code is light.
std::string linear_profile() {
  const cmsCIExyY white{0.3127, 0.329, 1};
  const cmsCIExyYTRIPLE primaries{{0.64, 0.33, 1}, {0.3, 0.6, 1}, {0.15, 0.06, 1}};
  cmsToneCurve* straight = cmsBuildGamma(nullptr, 1.0);
  cmsToneCurve* const curves[] = {straight, straight, straight};
  cmsHPROFILE profile = cmsCreateRGBProfile(&white, &primaries, curves);
  cmsUInt32Number size = 0;
  cmsSaveProfileToMem(profile, nullptr, &size);
  std::string bytes(size, '\0');
  cmsSaveProfileToMem(profile, bytes.data(), &size);
  cmsCloseProfile(profile);
  cmsFreeToneCurve(straight);
  return bytes;
}

class Webp : public Clips {
 protected:
  std::string webp(const std::string& name, int count, bool alpha, const std::string& more = "") const {
    return clip(name, "-c:v libwebp_anim -lossless 1 -pix_fmt bgra " + more, count, alpha);
  }
  /// The same frames in another lossless file of codes.
  std::string apng(const std::string& name, int count, bool alpha) const {
    return clip(name, std::string("-f apng -plays 0 -pix_fmt ") + (alpha ? "rgba" : "rgb24"), count, alpha);
  }
  std::string bytes_of(const std::string& file) const { return read_file(file).value(); }
  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path(name), std::ios::binary) << bytes;
    return path(name);
  }
};

TEST_F(Webp, LengthsOfNothingAreWhatBrowsersShow) {
  std::string bytes = bytes_of(webp("a.webp", 3, false));
  for (std::size_t at = bytes.find("ANMF"); at != std::string::npos; at = bytes.find("ANMF", at + 4))
    for (std::size_t i = 0; i < 3; ++i) bytes[at + 8 + 12 + i] = 0;  // behind place and size: the length
  const auto movie = open(write("none.webp", bytes));
  ASSERT_TRUE(movie);
  EXPECT_EQ(movie->facts().pts, (std::vector<long long>{0, 100, 200}));
  EXPECT_EQ(movie->facts().last_length, 100);
}

TEST_F(Webp, AnyFrameIsThatOfTheLosslessOriginal) {
  for (const bool alpha : {false, true}) {
    const auto movie = open(webp("a.webp", 30, alpha)), truth = open(apng("a.apng", 30, alpha));
    ASSERT_TRUE(movie && truth);
    ASSERT_EQ(movie->frames(), 30);
    EXPECT_EQ(movie->facts().has_alpha, alpha);
    EXPECT_EQ(movie->facts().size, (Size{kClipWidth, kClipHeight}));
    for (const int frame : {29, 0, 1, 28, 15, 14, 13, 3, 29}) {
      const auto picture = Clips::read(movie, frame).value(), original = Clips::read(truth, frame).value();
      EXPECT_EQ(number_of(picture), frame + 1);
      EXPECT_EQ(picture.has_alpha, alpha);
      float off = 0;
      for (std::size_t i = 0; i < picture.color.pixels.size(); ++i)
        off = std::max(off, std::abs(picture.color.pixels[i] - original.color.pixels[i]));
      EXPECT_LT(off, 1e-6f) << frame << (alpha ? " with alpha" : "");  // two ways of a code to light
    }
  }
}

/// As those of a WebP that does not move.
TEST_F(Webp, HasTheColoursAndTheOrientationOfItsHead) {
  const std::string bytes = bytes_of(webp("a.webp", 3, false)), profile = linear_profile();
  const auto chunk = [](const std::string& type, const std::string& data) {
    std::string head = type + "____";
    put_ordered(reinterpret_cast<unsigned char*>(&head[4]), 4, data.size(), false);
    return head + data + std::string(data.size() % 2, '\0');
  };
  const std::string exif("II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0\x06\0\0\0\0\0\0\0", 26);
  constexpr std::size_t kBehindHead = 30, kFlags = 20;  // RIFF, WEBP, VP8X
  std::string told = bytes.substr(0, kBehindHead) + chunk("ICCP", profile) + bytes.substr(kBehindHead);
  told += chunk("EXIF", exif);
  told[kFlags] = static_cast<char>(told[kFlags] | 0x28);
  put_ordered(reinterpret_cast<unsigned char*>(&told[4]), 4, told.size() - 8, false);
  const auto plain = open(path("a.webp")), linear = open(write("b.webp", told));
  ASSERT_TRUE(plain && linear);
  const Picture a = Clips::read(plain, 1).value(), b = Clips::read(linear, 1).value();
  ASSERT_EQ(b.color.size(), (Size{a.color.height, a.color.width})) << "turned";
  EXPECT_TRUE(b.facts->had_profile);
  const float* stored = a.color.at(0, a.color.height - 1);  // the lower left is the upper left now
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(srgb_to_linear(b.color.at(0, 0)[c]), stored[c], 1e-4) << c;
  EXPECT_THAT(messages_, IsEmpty()) << "sRGB needs no word";
}

TEST_F(Webp, FramesShowForTheirOwnTimes) {
  const auto movie =
      open(webp("varies.webp", 12, false, "-vf \"setpts='if(lt(N,6),N,6+(N-6)*3)/24/TB'\" -vsync passthrough"));
  ASSERT_TRUE(movie);
  ASSERT_EQ(movie->frames(), 12);
  EXPECT_TRUE(movie->variable_rate());
  for (int frame = 0; frame < 12; ++frame)
    EXPECT_NEAR(movie->time(frame), (frame < 6 ? frame : 6 + (frame - 6) * 3) / 24.0, 2e-3) << frame;
}

TEST_F(Webp, OnePictureIsNoVideo) {
  const std::string still = clip("still.webp", "-frames:v 1 -c:v libwebp -lossless 1", 1);
  EXPECT_EQ(movie_format(still), "");
}

TEST_F(Webp, WhatIsWholeOfATruncatedFileIsRead) {
  const std::string whole = bytes_of(webp("whole.webp", 12, false));
  const auto truth = open(path("whole.webp"));
  const auto movie = open(write("cut.webp", whole.substr(0, whole.size() / 2)));
  ASSERT_TRUE(movie);
  EXPECT_EQ(movie->facts().missing, 1u);
  ASSERT_GT(movie->frames(), 3);
  ASSERT_LT(movie->frames(), 12);
  EXPECT_THAT(messages_.back(), HasSubstr("cut.webp: is truncated: it ends after frame"));
  EXPECT_EQ(hash_of(movie, movie->frames() - 2), hash_of(truth, movie->frames() - 2));
  const auto last = Clips::read(movie, movie->frames() - 1);
  ASSERT_FALSE(last);
  EXPECT_THAT(last.error().text(), HasSubstr("is missing: the file ends before it"));
}

TEST_F(Webp, DamagedFramesAreNamed) {
  std::string bytes = bytes_of(webp("good.webp", 12, false));
  std::size_t at = 0;
  for (int frame = 0; frame < 6; ++frame) at = bytes.find("ANMF", at + 1);
  ASSERT_NE(at, std::string::npos);
  // 8 bytes of chunk, 16 of frame, 8 of picture: then what the picture is made of, after its signature and size.
  for (std::size_t i = at + 40; i < at + 60; ++i) bytes[i] = static_cast<char>(~bytes[i]);
  const auto movie = open(write("bad.webp", bytes));
  ASSERT_TRUE(movie);
  EXPECT_EQ(number_of(Clips::read(movie, 4).value()), 5);
  const auto bad = Clips::read(movie, 5);
  ASSERT_FALSE(bad);
  EXPECT_THAT(bad.error().text(), HasSubstr("bad.webp: error: frame 6 cannot be decoded: it is damaged"));
  EXPECT_THAT(Clips::read(movie, 8).error().text(), HasSubstr("frame 9 is built on frame 6, which is damaged"));
  EXPECT_EQ(number_of(Clips::read(movie, 4).value()), 5);
}

TEST_F(Webp, WhatIsNoneIsRefused) {
  const std::string good = bytes_of(webp("good.webp", 3, false));
  const auto refused = [&](const std::string& bytes) {
    const auto movie = try_open(write("bad.webp", bytes));
    EXPECT_FALSE(movie);
    EXPECT_THAT(movie ? "" : movie.error().text(), HasSubstr("bad.webp: error: "));
  };
  refused(good.substr(0, 30));
  refused(good.substr(0, 60));
  std::string large = good;
  large.replace(24, 6, "\xff\xff\xff\xff\xff\xff");  // sides of 16 million
  refused(large);
}

}  // namespace
}  // namespace afterglow
