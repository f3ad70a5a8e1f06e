// SPDX-License-Identifier: MIT
// Missing, damaged and hostile files: one clear error, no crash, nothing large allocated.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstring>
#include <random>

#include "make_files.h"
#include "memory_cap.h"
#include "raw_png.h"
#include "temporary_folder.h"

namespace afterglow {
namespace {
using testing::HasSubstr;

/// The error of reading; header and picture must agree that there is one when `header_too`.
Error error_of(const std::filesystem::path& file, const ReadOptions& options = {}) {
  Diagnostics silent;
  const auto picture = read_picture(file, options, silent);
  EXPECT_FALSE(picture) << file;
  if (picture) return {};
  EXPECT_EQ(picture.error().kind, ErrorKind::io);
  EXPECT_EQ(picture.error().file, file.string());
  EXPECT_EQ(picture.error().message.find('\n'), std::string::npos);
  return picture.error();
}

TEST(BadFiles, NotPictures) {
  const TemporaryFolder folder;
  EXPECT_EQ(error_of(folder / "no.exr").message, "no such file");
  EXPECT_THAT(error_of(folder.path()).message, HasSubstr("folder"));
  write_bytes(folder / "empty.exr", "");
  EXPECT_EQ(error_of(folder / "empty.exr").message, "is empty");
  ASSERT_EQ(mkfifo((folder / "pipe.exr").c_str(), 0600), 0);
  EXPECT_EQ(error_of(folder / "pipe.exr").message, "is not a regular file");  // and does not hang
  for (const char* name : {"a.exr", "a.png", "a.jpg", "a.tif", "a.hdr", "a.txt", "a"}) {
    write_bytes(folder / name, "this is no picture at all, whatever its name may say");
    EXPECT_THAT(error_of(folder / name).message,
                testing::AnyOf(HasSubstr("not a picture"), HasSubstr("cannot be read")))
        << name;
  }
}

TEST(BadFiles, ContentDecidesNotTheName) {
  const TemporaryFolder folder;
  ASSERT_NO_FATAL_FAILURE(make_file(folder / "a.exr", 3, 2, {"R", "G", "B"}, OIIO::TypeHalf));
  std::filesystem::rename(folder / "a.exr", folder / "a.png");
  EXPECT_EQ(read_or_fail(folder / "a.png").color.at(1, 1)[2], mark(1, 1, 2));
}

/// Files of every kind of reader, cut and spoilt.
class Damaged : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const std::string name = GetParam();
    const auto file = folder_ / ("whole" + extension());
    if (name == "parts.exr") {
      auto a = make_spec(40, 40, {"R", "G", "B"}, OIIO::TypeHalf), b = make_spec(40, 40, {"Z"}, OIIO::TypeFloat);
      a.attribute("oiio:subimagename", "rgba");
      b.attribute("oiio:subimagename", "depth");
      ASSERT_NO_FATAL_FAILURE(make_file(file, {a, b}, {marks(40, 40, 3), marks(40, 40, 1)}));
    } else if (name == "chroma.exr") {
      std::filesystem::copy_file(test_image("openexr/Chromaticities_Rec709_YC.exr"), file);
    } else {
      const bool floats = name.find("float") != std::string::npos;
      const bool integer = extension() != ".exr" && extension() != ".hdr" && !floats;
      OIIO::ImageSpec spec = make_spec(61, 47, {"R", "G", "B"},
                                       integer  ? OIIO::TypeUInt8
                                       : floats ? OIIO::TypeFloat
                                                : OIIO::TypeHalf);
      if (name.find("tiled") != std::string::npos) spec.tile_width = spec.tile_height = 16;
      if (name.find("stored") != std::string::npos) spec.attribute("compression", "none");
      if (name.find("piz") != std::string::npos) spec.attribute("compression", "piz");
      if (name.find("dwaa") != std::string::npos) spec.attribute("compression", "dwaa");
      ASSERT_NO_FATAL_FAILURE(make_file(file, {spec}, {marks(61, 47, 3)}));
    }
    whole_ = file_bytes(file);
  }
  std::string extension() const { return std::filesystem::path(GetParam()).extension().string(); }
  TemporaryFolder folder_;
  std::string whole_;
};

TEST_P(Damaged, TruncatedAnywhereIsAnError) {
  const auto file = folder_ / ("cut" + extension());
  Diagnostics silent;
  ReadOptions options;
  options.auxiliary = {"depth"};
  for (std::size_t i = 0; i < 16; ++i) {
    write_bytes(file, whole_.substr(0, whole_.size() * i / 16));
    EXPECT_FALSE(read_picture(file, options, silent)) << "cut to " << i << "/16";
  }
  for (const std::size_t missing : {std::size_t{1}, std::size_t{2}, std::size_t{9}, std::size_t{40}}) {
    if (extension() == ".tga") continue;  // ends in notes that the pixels do not need
    write_bytes(file, whole_.substr(0, whole_.size() - missing));
    EXPECT_FALSE(read_picture(file, options, silent)) << missing << " bytes missing";
  }
  write_bytes(file, whole_);
  EXPECT_TRUE(read_picture(file, options, silent));
}

TEST_P(Damaged, SpoiltBytesNeverCrash) {
  const auto file = folder_ / ("bad" + extension());
  Diagnostics silent;
  ReadOptions options;
  options.auxiliary = {"depth", "normal"};
  options.max_side = 2048;
  options.max_bytes = 256 << 20;
  std::mt19937 random(11);
  for (int round = 0; round < 150; ++round) {
    std::string bytes = whole_;
    // Headers are where bytes matter most.
    const std::size_t reach = round % 3 ? std::min<std::size_t>(bytes.size(), 512) : bytes.size();
    for (int i = 0; i < 1 + round % 5; ++i) bytes[random() % reach] = static_cast<char>(random());
    write_bytes(file, bytes);
    const auto picture = read_picture(file, options, silent);
    if (!picture) {
      EXPECT_EQ(picture.error().kind, ErrorKind::io);
      EXPECT_FALSE(picture.error().message.empty());
    } else {
      for (const float v : picture.value().color.pixels) ASSERT_TRUE(std::isfinite(v));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, Damaged,
                         testing::Values("zip.exr", "piz.exr", "dwaa.exr", "tiled.exr", "parts.exr", "chroma.exr",
                                         "plain.png", "plain.jpg", "plain.tif", "tiled.tif", "float.tif",
                                         "stored_float.tif", "plain.hdr", "plain.bmp", "plain.tga"),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::replace(name.begin(), name.end(), '.', '_');
                           return name;
                         });

class Bombs : public testing::Test {
 protected:
  /// Overwrites the bytes behind an EXR attribute's name, type and size.
  static void patch(std::string& bytes, const std::string& attribute, const std::string& type, std::size_t offset,
                    std::int32_t value) {
    const std::size_t at = bytes.find(attribute + '\0' + type + '\0');
    ASSERT_NE(at, std::string::npos);
    std::memcpy(&bytes[at + attribute.size() + type.size() + 2 + 4 + offset], &value, sizeof value);
  }
  std::string exr(bool tiled = false) {
    OIIO::ImageSpec spec = make_spec(8, 8, {"R", "G", "B"}, OIIO::TypeHalf);
    if (tiled) spec.tile_width = spec.tile_height = 4;
    make_file(folder_ / "small.exr", {spec}, {marks(8, 8, 3)});
    return file_bytes(folder_ / "small.exr");
  }
  Error refused(const std::string& bytes, const char* name = "bomb.exr") {
    write_bytes(folder_ / name, bytes);
    const MemoryCap cap;
    EXPECT_FALSE(read_header(folder_ / name, {}));
    return error_of(folder_ / name);
  }
  TemporaryFolder folder_;
};

TEST_F(Bombs, HugeExrWindows) {
  std::string wide = exr(), tall = exr(), shown = exr(), far = exr(), empty = exr();
  patch(wide, "dataWindow", "box2i", 8, 1 << 29);
  EXPECT_THAT(refused(wide).message, HasSubstr("larger than 16384"));
  patch(tall, "dataWindow", "box2i", 12, 1 << 29);
  EXPECT_THAT(refused(tall).message, HasSubstr("larger than 16384"));
  patch(shown, "displayWindow", "box2i", 8, 1 << 29);
  EXPECT_THAT(refused(shown).message, HasSubstr("display window"));
  patch(far, "dataWindow", "box2i", 0, -2147483647);
  EXPECT_THAT(refused(far).message, HasSubstr("out of range"));
  patch(empty, "dataWindow", "box2i", 8, -1);
  EXPECT_THAT(refused(empty).message, HasSubstr("empty"));
}

TEST_F(Bombs, ExrAttributesLargerThanTheFile) {
  std::string bytes = exr();
  const std::string key = std::string("compression") + '\0' + "compression" + '\0';
  const std::size_t at = bytes.find(key);
  ASSERT_NE(at, std::string::npos);
  const std::int32_t size = 0x7fffffff;
  std::memcpy(&bytes[at + key.size()], &size, 4);
  EXPECT_THAT(refused(bytes).message, HasSubstr("more bytes than the file has"));
}

TEST_F(Bombs, HugeExrTiles) {
  std::string bytes = exr(true);
  patch(bytes, "tiles", "tiledesc", 0, 1 << 28);
  patch(bytes, "tiles", "tiledesc", 4, 1 << 28);
  EXPECT_THAT(refused(bytes).message, HasSubstr("to decode"));
}

TEST_F(Bombs, HugePngAndJpeg) {
  EXPECT_THAT(refused(RawPng(0x7f000004, 4, 8, 2).pixels({"x"}).finish(), "bomb.png").message,
              HasSubstr("larger than 16384"));
  make_file(folder_ / "a.jpg", 4, 4, {"R", "G", "B"}, OIIO::TypeUInt8);
  std::string jpeg = file_bytes(folder_ / "a.jpg");
  const std::size_t frame = jpeg.find("\xff\xc0");
  ASSERT_NE(frame, std::string::npos);
  jpeg[frame + 5] = jpeg[frame + 7] = static_cast<char>(0xff);
  EXPECT_THAT(refused(jpeg, "bomb.jpg").message, HasSubstr("larger than 16384"));
}

TEST_F(Bombs, HugeHdr) {
  EXPECT_THAT(refused("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1000000 +X 1000000\n", "bomb.hdr").message,
              HasSubstr("larger than 16384"));
}

TEST_F(Bombs, SidesThatAreAllowedButCannotBeThere) {
  std::string bytes = exr();
  patch(bytes, "dataWindow", "box2i", 8, 16000);
  patch(bytes, "dataWindow", "box2i", 12, 16000);
  EXPECT_THAT(refused(bytes).message, HasSubstr("cannot hold its pixels"));
  EXPECT_THAT(refused(RawPng(16000, 16000, 1, 0).pixels({"x"}).finish(), "bomb.png").message,
              HasSubstr("cannot hold its pixels"));
}

TEST_F(Bombs, EmptyLookingPicturesAreNoBombs) {
  // Black compresses as well as anything can.
  for (const char* compression : {"none", "rle", "zip", "zips", "pxr24", "piz", "dwaa"}) {
    OIIO::ImageSpec spec = make_spec(2000, 1500, {"R", "G", "B", "A"}, OIIO::TypeFloat);
    spec.attribute("compression", compression);
    ASSERT_NO_FATAL_FAILURE(make_file(folder_ / "black.exr", {spec}, {std::vector<float>(2000 * 1500 * 4)}));
    EXPECT_EQ(read_or_fail(folder_ / "black.exr").color.at(1999, 1499)[0], 0) << compression;
  }
  OIIO::ImageSpec spec = make_spec(4000, 3000, {"Y"}, OIIO::TypeUInt8);
  spec.attribute("png:compressionLevel", 9);
  ASSERT_NO_FATAL_FAILURE(make_file(folder_ / "black.png", {spec}, {std::vector<float>(4000 * 3000)}));
  EXPECT_EQ(read_or_fail(folder_ / "black.png").color.at(3999, 2999)[0], 0);
}

TEST_F(Bombs, MemoryLimitIsKept) {
  make_file(folder_ / "a.exr", 200, 100, {"R", "G", "B"}, OIIO::TypeHalf);
  ReadOptions options;
  options.max_bytes = 200 * 100 * 16;  // the pixels fit, the decoder's buffers do not
  EXPECT_THAT(error_of(folder_ / "a.exr", options).message, HasSubstr("--max-memory"));
  options.max_bytes = 0;
  EXPECT_FALSE(read_header(folder_ / "a.exr", options).ok() &&
               read_header(folder_ / "a.exr", options).value().host_bytes == 0);
  options = {};
  options.max_side = 199;
  EXPECT_THAT(error_of(folder_ / "a.exr", options).message, HasSubstr("200×100"));
}

TEST_F(Bombs, ManyChannelsAndLongNames) {
  std::vector<std::string> names{"R", "G", "B"};
  for (int i = 0; i < 300; ++i) names.push_back("layer" + std::to_string(i) + ".R");
  ASSERT_NO_FATAL_FAILURE(
      make_file(folder_ / "many.exr", {make_spec(3, 3, names, OIIO::TypeHalf)}, {marks(3, 3, 303)}));
  const Picture picture = read_or_fail(folder_ / "many.exr");
  EXPECT_EQ(picture.color.at(2, 2)[1], mark(2, 2, 1));
  ReadOptions options;
  options.layer = "layr7";
  const Error error = error_of(folder_ / "many.exr", options);
  EXPECT_EQ(error.nearest, "layer7");
  EXPECT_LT(error.allowed.size(), 1000u);
}

}  // namespace
}  // namespace afterglow
