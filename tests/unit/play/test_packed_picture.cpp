// SPDX-License-Identifier: MIT
// Pictures in less memory: the same bits come back, whatever they were read from.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <bit>
#include <cstring>
#include <filesystem>
#include <random>

#include "core/half.h"
#include "image/reader.h"
#include "image/srgb.h"
#include "play/packed_picture.h"
#include "play/read_ahead.h"

namespace afterglow {
namespace {

using Form = PackedPixels::Form;

/// Larger than what is looked at first, and no multiple of it.
constexpr int kWidth = 131, kHeight = 67;

Image halves(unsigned seed, int channels = 4) {
  Image out(kWidth, kHeight, channels);
  std::mt19937 random(seed);
  for (float& v : out.pixels) v = float_from_half(static_cast<std::uint16_t>(random() % (kMaxHalfBits + 1)));
  return out;
}

Image codes(unsigned seed) {
  Image out(kWidth, kHeight, 4);
  const std::vector<float> lights = srgb_decode_table(255);
  std::mt19937 random(seed);
  for (std::size_t i = 0; i < out.pixels.size(); ++i) out.pixels[i] = i % 4 == 3 ? 1 : lights[random() % 256];
  return out;
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0);
}

/// As which it is kept; the bits come back.
Form form_of(const Image& image) {
  Image taken = image;
  const PackedPixels packed(taken);
  EXPECT_EQ(taken.pixels.capacity(), 0u);  // its memory is free, too
  std::vector<float> back{1, 2, 3};
  packed.open(back);
  EXPECT_TRUE(same_bits(back, image.pixels));
  return packed.form();
}

TEST(PackedPixels, TakeTheSmallestFormThatLosesNothing) {
  EXPECT_EQ(form_of(halves(1)), Form::halves);
  EXPECT_EQ(form_of(halves(2, 1)), Form::halves);
  EXPECT_EQ(form_of(codes(3)), Form::codes);
  EXPECT_EQ(form_of(Image()), Form::floats);
  // The last pixel decides as well as the first one.
  const std::size_t last = std::size_t{kWidth} * kHeight * 4 - 1;
  for (const std::size_t at : {std::size_t{0}, std::size_t{9000}, last - 1}) {
    Image image = halves(4);
    image.pixels[at] = std::nextafter(0.5f, 1.0f);
    EXPECT_EQ(form_of(image), Form::floats) << at;
    image.pixels[at] = 1e6f;
    EXPECT_EQ(form_of(image), Form::floats) << at;
    image = codes(5);
    image.pixels[at] = std::nextafter(image.pixels[at], 2.0f);
    EXPECT_EQ(form_of(image), Form::floats) << at;
  }
  Image image = codes(6);
  image.pixels[last] = 0.5f;
  EXPECT_EQ(form_of(image), Form::floats) << "a colour that another one shines through";
  image = codes(7);
  image.pixels[4] = -0.0f;
  EXPECT_EQ(form_of(image), Form::floats);
  image = halves(8);
  image.pixels[4] = -0.0f;
  EXPECT_EQ(form_of(image), Form::halves);
}

/// What this program reads of a file with 8-bit codes is what it takes for codes.
TEST(PackedPixels, AreCodesOfFilesThatHoldThem) {
  const auto file = std::filesystem::temp_directory_path() / ("afterglow_codes" + std::to_string(getpid()) + ".png");
  std::vector<std::uint8_t> written(std::size_t{kWidth} * kHeight * 3);
  std::mt19937 random(1);
  for (std::uint8_t& code : written) code = static_cast<std::uint8_t>(random());
  const auto output = OIIO::ImageOutput::create("png");
  ASSERT_TRUE(output->open(file.string(), OIIO::ImageSpec(kWidth, kHeight, 3, OIIO::TypeDesc::UINT8)));
  ASSERT_TRUE(output->write_image(OIIO::TypeDesc::UINT8, written.data()));
  output->close();
  Diagnostics nowhere;
  const auto read = read_picture(file, {}, nowhere);
  std::filesystem::remove(file);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(form_of(read->color), Form::codes);
}

Picture picture_of(Image color) {
  Picture out;
  out.color = std::move(color);
  out.data_window = {0, 0, kWidth, kHeight};
  out.content["source"] = hash_text("content");
  Image depth(kWidth, kHeight, 1);
  for (float& v : depth.pixels) v = 0.1f;
  out.auxiliary["depth"] = std::move(depth);
  out.auxiliary["normal"] = halves(9, 3);
  return out;
}

TEST(PackedPicture, ComesBackWithAllThatItHad) {
  for (const Image& color : {halves(1), codes(2), Image(kWidth, kHeight, 4)}) {
    const Picture before = picture_of(color);
    const PackedPicture packed(before);
    EXPECT_TRUE(packed.smaller());
    const Picture after = packed.open(std::vector<float>(7, 3.0f));
    EXPECT_TRUE(same_bits(after.color.pixels, before.color.pixels));
    EXPECT_EQ(after.color.size(), before.color.size());
    ASSERT_EQ(after.auxiliary.size(), 2u);
    for (const auto& [name, image] : before.auxiliary) {
      EXPECT_TRUE(same_bits(after.auxiliary.at(name).pixels, image.pixels)) << name;
      EXPECT_EQ(after.auxiliary.at(name).channels, image.channels);
    }
    EXPECT_EQ(after.content, before.content);
    EXPECT_EQ(after.data_window, before.data_window);
  }
  constexpr std::uint64_t kPixels = std::uint64_t{kWidth} * kHeight, kAuxiliary = kPixels * (4 + 3 * 2);
  EXPECT_EQ(PackedPicture(picture_of(halves(1))).bytes(), kPixels * 8 + kAuxiliary);
  EXPECT_EQ(PackedPicture(picture_of(codes(1))).bytes(), kPixels * 3 + kAuxiliary);
  Image odd = halves(1);
  odd.pixels[0] = 0.1f;
  PackedPicture kept(picture_of(odd));
  EXPECT_FALSE(kept.smaller());
  EXPECT_EQ(kept.bytes(), kPixels * (16 + 4 + 12));
  const Picture whole = std::move(kept).whole();
  EXPECT_TRUE(same_bits(whole.color.pixels, odd.pixels));
  EXPECT_TRUE(same_bits(whole.auxiliary.at("normal").pixels, halves(9, 3).pixels));
}

/// Twice as many halves fit where floats would, and whoever holds one has it for as long.
TEST(ReadAheadPacked, HoldsMoreAndGivesTheSame) {
  constexpr std::uint64_t kBytes = std::uint64_t{kWidth} * kHeight * 8;
  const auto made = [](int key) {
    Picture picture;
    picture.color = halves(static_cast<unsigned>(key));
    return picture;
  };
  ReadAhead ahead([&](int key) -> Result<Picture> { return made(key); }, {4 * kBytes, 1});
  ahead.want({1, 2, 3, 4});
  for (const int key : {4, 3, 2, 1})
    EXPECT_TRUE(same_bits(ahead.wait(key)->picture.color.pixels, made(key).color.pixels));
  EXPECT_EQ(ahead.stats().pictures, 4);
  EXPECT_EQ(ahead.stats().bytes, 4 * kBytes);
  EXPECT_EQ(ahead.stats().pixels * 8, ahead.stats().bytes);
  EXPECT_TRUE(ahead.has(3));
  EXPECT_FALSE(ahead.has(5));
  const auto held = ahead.find(2);
  EXPECT_EQ(ahead.find(2), held);
  for (const int key : {1, 3, 4, 1, 3})
    EXPECT_TRUE(same_bits(ahead.find(key)->picture.color.pixels, made(key).color.pixels));
  EXPECT_TRUE(same_bits(held->picture.color.pixels, made(2).color.pixels)) << "its memory was given to others";
  ahead.forget();
  EXPECT_TRUE(same_bits(held->picture.color.pixels, made(2).color.pixels));
}

}  // namespace
}  // namespace afterglow
