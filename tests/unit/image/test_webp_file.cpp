// SPDX-License-Identifier: MIT
// WebP stills: straight codes, orientation and what else their EXIF says.
#include <gtest/gtest.h>
#include <webp/decode.h>

#include <fstream>

#include "core/file.h"
#include "image/metadata.h"
#include "make_files.h"
#include "temporary_folder.h"
#include "wedge.h"

namespace afterglow {
namespace {

TEST(WebpFile, HoldsStraightCodes) {
  const TemporaryFolder folder;
  const Picture picture = wedge(37, 53, true);
  for (const char* name : {"o.webp", "o.pam"}) ASSERT_TRUE(write(picture, folder / name, with(SampleType::automatic)));
  const std::string webp = read_file(folder / "o.webp").value(), pam = read_file(folder / "o.pam").value();
  int width = 0, height = 0;
  std::uint8_t* pixels =
      WebPDecodeRGBA(reinterpret_cast<const std::uint8_t*>(webp.data()), webp.size(), &width, &height);
  ASSERT_TRUE(pixels);
  EXPECT_EQ((Size{width, height}), (Size{37, 53}));
  const std::string codes(reinterpret_cast<const char*>(pixels), 37 * 53 * 4);
  WebPFree(pixels);
  EXPECT_TRUE(pam.ends_with(codes));
}

/// Soft edges keep their colours: nothing is multiplied in 8 bits.
TEST(WebpFile, IsReadStraight) {
  const TemporaryFolder folder;
  Picture picture = wedge(16, 16, true);
  for (std::size_t i = 0; i < picture.color.pixels.size(); i += 4) {
    const float alpha = static_cast<float>(i / 4 % 16 + 1) / 255;
    picture.color.pixels[i + 3] = alpha;
    for (std::size_t c = 0; c < 3; ++c) picture.color.pixels[i + c] = alpha * (c == 0 ? 0.5f : 0.1f);
  }
  picture.has_alpha = true;
  for (const char* name : {"o.webp", "o.png"})
    ASSERT_TRUE(write(picture, folder / name, with(SampleType::automatic))) << name;
  const Picture webp = read_or_fail(folder / "o.webp"), png = read_or_fail(folder / "o.png");
  ASSERT_EQ(webp.color.pixels.size(), png.color.pixels.size());
  for (std::size_t i = 0; i < png.color.pixels.size(); ++i)
    ASSERT_FLOAT_EQ(webp.color.pixels[i], png.color.pixels[i]) << i;
}

/// As the container's specification has it: the chunk begins with the TIFF head.
TEST(WebpFile, SaysWhatItsExifSays) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write(wedge(40, 24, false), folder / "a.webp"));
  const std::string plain = read_file(folder / "a.webp").value();
  const std::string exif("II*\0\x08\0\0\0\x02\0\x12\x01\x03\0\x01\0\0\0\x06\0\0\0\x3b\x01\x02\0\x04\0\0\0Ann\0\0\0\0\0",
                         38);
  for (const bool named : {false, true}) {
    std::string chunk = (named ? std::string("Exif\0\0", 6) : "") + exif;
    const auto number = [](std::size_t value, int bytes) {
      std::string out;
      for (int i = 0; i < bytes; ++i) out += static_cast<char>(value >> (8 * i) & 255);
      return out;
    };
    const std::string body = "WEBPVP8X" + number(10, 4) + std::string("\x08\0\0\0", 4) + number(39, 3) + number(23, 3) +
                             plain.substr(12) + "EXIF" + number(chunk.size(), 4) + chunk;
    std::ofstream(folder / "b.webp", std::ios::binary) << "RIFF" << number(body.size(), 4) << body;
    const Picture picture = read_or_fail(folder / "b.webp");
    EXPECT_EQ(picture.color.size(), (Size{24, 40})) << named;
    EXPECT_TRUE(find_metadata(picture.facts->metadata, "Artist")) << named;
  }
}

/// As EXIF; the pixels are those without.
TEST(WebpFile, KeepsMetadata) {
  const TemporaryFolder folder;
  for (const char* compression : {"", "lossy:80"})
    for (const bool alpha : {false, true}) {
      Picture picture = wedge(37, 53, alpha);
      ASSERT_TRUE(write(picture, folder / "plain.webp", compressed(compression)));
      auto facts = std::make_shared<FileFacts>();
      facts->metadata = {{"Artist", std::string("J\xc3\xbcrgen")},
                         {"XResolution", 100.f},
                         {"YResolution", 100.f},
                         {"ResolutionUnit", std::string("cm")}};
      picture.facts = facts;
      ASSERT_TRUE(write(picture, folder / "said.webp", compressed(compression)));
      const Picture plain = read_or_fail(folder / "plain.webp"), said = read_or_fail(folder / "said.webp");
      EXPECT_EQ(said.color.pixels, plain.color.pixels);
      EXPECT_EQ(said.has_alpha, alpha);
      EXPECT_EQ(metadata_text(*find_metadata(said.facts->metadata, "Artist")), "J\xc3\xbcrgen");
      EXPECT_NEAR(metadata_number(*find_metadata(said.facts->metadata, "XResolution"), 0), 254, 0.1) << "of an inch";
      EXPECT_FALSE(find_metadata(plain.facts->metadata, "Artist"));
    }
}

TEST(WebpFile, Lossy) {
  const TemporaryFolder folder;
  Picture picture = wedge(64, 64, false);
  ASSERT_TRUE(write(picture, folder / "a.webp"));
  ASSERT_TRUE(write(picture, folder / "b.webp", compressed("lossy:10")));
  EXPECT_LT(std::filesystem::file_size(folder / "b.webp"), std::filesystem::file_size(folder / "a.webp"));
  EXPECT_EQ(read_or_fail(folder / "b.webp").color.size(), (Size{64, 64}));
}

}  // namespace
}  // namespace afterglow
