// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "image/writer.h"
#include "make_files.h"
#include "temporary_folder.h"

namespace afterglow {
namespace {

TEST(PixelMemory, IsHandedOutAgain) {
  PixelMemory memory;
  Picture picture;
  picture.color.pixels = memory.take(100);
  const float* first = picture.color.pixels.data();
  memory.give(std::move(picture));
  const auto again = memory.take(100);
  EXPECT_EQ(again.data(), first);
  EXPECT_NE(memory.take(100).data(), first);
}

TEST(PixelMemory, OtherSizesAreLetGo) {
  PixelMemory memory;
  Picture small, large;
  small.color.pixels = memory.take(100);
  large.color.pixels = memory.take(200);
  memory.give(std::move(small));  // no longer wanted
  EXPECT_EQ(memory.take(100).size(), 100u);
  memory.give(std::move(large));
  EXPECT_EQ(memory.take(200).size(), 200u);
}

TEST(PixelMemory, KeepsCodesOfPicturesOfThatSize) {
  PixelMemory memory;
  EXPECT_TRUE(memory.take_codes().empty());
  Picture picture, other;
  picture.color.pixels = memory.take(100);
  picture.unorm8.resize(100);
  other.unorm8.resize(50);
  const std::uint8_t* codes = picture.unorm8.data();
  memory.give(std::move(picture));
  memory.give(std::move(other));
  EXPECT_EQ(memory.take_codes().data(), codes);
  EXPECT_TRUE(memory.take_codes().empty());
  Picture last;
  last.unorm8.resize(100);
  memory.give(std::move(last));
  static_cast<void>(memory.take(60));  // another size is wanted
  EXPECT_TRUE(memory.take_codes().empty());
}

TEST(WorkMemory, IsUsedAgainWhereItIsOfAboutThatSize) {
  WorkMemory memory;
  auto block = memory.take(100);
  const std::uint8_t* first = block.bytes.get();
  memory.give(std::move(block));
  block = memory.take(80);
  EXPECT_EQ(block.bytes.get(), first);
  EXPECT_EQ(block.size, 100u);
  memory.give(std::move(block));
  EXPECT_EQ(memory.take(30).size, 30u);  // much smaller: the large one goes
  block = memory.take(10);
  memory.give(std::move(block));
  EXPECT_EQ(memory.take(200).size, 200u);
}

/// Whatever was in it, pictures of every kind are read as into new memory.
TEST(PixelMemory, PicturesAreReadOverAnything) {
  const TemporaryFolder folder;
  using Names = std::vector<std::string>;
  int number = 0;
  for (const Names& channels :
       {Names{"R", "G", "B", "A"}, Names{"R", "G", "B"}, Names{"Y"}, Names{"Y", "A"}, Names{"R", "G"}})
    for (const char* extension : {".exr", ".png", ".tif"}) {
      if (std::string(extension) != ".exr" && channels.size() == 2 && channels[1] == "G") continue;
      const auto file = folder / (std::to_string(number++) + extension);
      const auto type = std::string(extension) == ".exr" ? OIIO::TypeDesc(OIIO::TypeDesc::HALF)
                                                         : OIIO::TypeDesc(OIIO::TypeDesc::UINT8);
      ASSERT_NO_FATAL_FAILURE(make_file(file, 13, 9, channels, type));
      const Picture before = read_or_fail(file);
      PixelMemory memory;
      Picture dirty;
      dirty.color.pixels = memory.take(13 * 9 * 4);
      std::fill(dirty.color.pixels.begin(), dirty.color.pixels.end(), 7.0f);
      memory.give(std::move(dirty));
      ReadOptions options;
      options.memory = &memory;
      EXPECT_EQ(read_or_fail(file, options).color.pixels, before.color.pixels) << file;
    }
}

}  // namespace
}  // namespace afterglow
