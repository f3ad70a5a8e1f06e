// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "make_files.h"
#include "temporary_folder.h"

namespace afterglow {
namespace {
using testing::HasSubstr;

class Auxiliary : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_NO_FATAL_FAILURE(make_file(folder_ / "color.exr", 7, 5, {"R", "G", "B"}, OIIO::TypeHalf));
    ASSERT_NO_FATAL_FAILURE(
        make_file(folder_ / "both.exr", 7, 5, {"R", "G", "B", "Z", "near.Z", "N.X", "N.Y", "N.Z"}, OIIO::TypeFloat));
    ASSERT_NO_FATAL_FAILURE(make_file(folder_ / "other.exr", 7, 6, {"Z"}, OIIO::TypeFloat));
    options_.auxiliary = {"depth", "normal"};
  }
  Error error_of(const std::string& name) {
    Diagnostics silent;
    auto picture = read_picture(folder_ / name, options_, silent);
    EXPECT_FALSE(picture);
    return picture ? Error{} : picture.error();
  }
  TemporaryFolder folder_;
  ReadOptions options_;
};

TEST_F(Auxiliary, OnlyWhatIsAskedFor) {
  options_.auxiliary = {"normal"};
  const Picture picture = read_or_fail(folder_ / "both.exr", options_);
  EXPECT_EQ(picture.auxiliary.size(), 1u);
  EXPECT_EQ(picture.auxiliary.at("normal").channels, 3);
  options_.auxiliary = {};
  EXPECT_TRUE(read_or_fail(folder_ / "both.exr", options_).auxiliary.empty());
}

TEST_F(Auxiliary, ChannelsGoWhereTheyBelong) {
  const Picture picture = read_or_fail(folder_ / "both.exr", options_);
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 7; ++x) {
      for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(picture.color.at(x, y)[c], mark(x, y, c));
        EXPECT_EQ(picture.auxiliary.at("normal").at(x, y)[c], mark(x, y, 5 + c));
      }
      EXPECT_EQ(*picture.auxiliary.at("depth").at(x, y), mark(x, y, 3));
    }
  }
}

TEST_F(Auxiliary, ByChannelName) {
  options_.depth = {"", "near.Z"};
  EXPECT_EQ(*read_or_fail(folder_ / "both.exr", options_).auxiliary.at("depth").at(3, 2), mark(3, 2, 4));
  // A channel of the colour itself may be asked for too.
  options_.depth = {"", "G"};
  const Picture picture = read_or_fail(folder_ / "both.exr", options_);
  EXPECT_EQ(*picture.auxiliary.at("depth").at(3, 2), mark(3, 2, 1));
  EXPECT_EQ(picture.color.at(3, 2)[1], mark(3, 2, 1));
  options_.depth = {"", "near.Y"};
  const Error error = error_of("both.exr");
  EXPECT_EQ(error.nearest, "near.Z");
  EXPECT_THAT(error.allowed, HasSubstr("near.Z"));
  EXPECT_EQ(error.file, (folder_ / "both.exr").string());
}

TEST_F(Auxiliary, FromAnotherFile) {
  options_.depth = {folder_ / "both.exr", ""};
  options_.normal = {folder_ / "both.exr", "N"};
  const Picture picture = read_or_fail(folder_ / "color.exr", options_);
  EXPECT_EQ(*picture.auxiliary.at("depth").at(6, 4), mark(6, 4, 3));
  EXPECT_EQ(picture.auxiliary.at("normal").at(6, 4)[2], mark(6, 4, 7));
}

TEST_F(Auxiliary, PlainPicturesServeAsDepthAndNormals) {
  ASSERT_NO_FATAL_FAILURE(make_file(folder_ / "depth.png", 7, 5, {"Y"}, OIIO::TypeUInt16));
  options_.depth = {folder_ / "depth.png", ""};
  options_.normal = {folder_ / "color.exr", ""};
  const Picture picture = read_or_fail(folder_ / "color.exr", options_);
  EXPECT_NEAR(*picture.auxiliary.at("depth").at(4, 3), mark(4, 3, 0), 1e-5);  // as stored, not decoded
  EXPECT_EQ(picture.auxiliary.at("normal").at(4, 3)[1], mark(4, 3, 1));
  options_.normal = {folder_ / "depth.png", ""};
  EXPECT_THAT(error_of("color.exr").message, HasSubstr("no normal layer"));
}

TEST_F(Auxiliary, AnotherSizeIsAnError) {
  options_.depth = {folder_ / "other.exr", ""};
  const Error error = error_of("color.exr");
  EXPECT_EQ(error.kind, ErrorKind::io);
  EXPECT_EQ(error.file, (folder_ / "other.exr").string());
  EXPECT_THAT(error.message, HasSubstr("7×6"));
  EXPECT_THAT(error.message, HasSubstr("7×5"));
}

TEST_F(Auxiliary, MissingFiles) {
  options_.depth = {folder_ / "no.exr", "Z"};
  EXPECT_EQ(error_of("color.exr").message, "no such file");
  options_.depth = {"", "no.exr"};  // what parse_layer_choice makes of a file that is not there
  EXPECT_EQ(error_of("color.exr").message, "no such file");
}

TEST_F(Auxiliary, PartsWithOtherWindowsAreCutAndPadded) {
  auto beauty = make_spec(4, 3, {"R", "G", "B"}, OIIO::TypeFloat), depth = make_spec(4, 3, {"Z"}, OIIO::TypeFloat);
  beauty.attribute("oiio:subimagename", "rgba");
  depth.attribute("oiio:subimagename", "depth");
  beauty.x = 2;
  depth.x = 3;
  depth.y = 1;
  for (OIIO::ImageSpec* spec : {&beauty, &depth}) {
    spec->full_width = 10;
    spec->full_height = 10;
  }
  ASSERT_NO_FATAL_FAILURE(make_file(folder_ / "parts.exr", {beauty, depth}, {marks(4, 3, 3), marks(4, 3, 1)}));
  const Picture picture = read_or_fail(folder_ / "parts.exr", options_);
  const Image& image = picture.auxiliary.at("depth");
  ASSERT_EQ(image.size(), picture.color.size());
  EXPECT_EQ(image.size(), (Size{10, 10}));
  EXPECT_EQ(*image.at(2, 2), 1e10f);  // left of the depth's window
  EXPECT_EQ(*image.at(3, 0), 1e10f);  // above it
  EXPECT_EQ(*image.at(3, 1), mark(0, 0, 0));
  EXPECT_EQ(*image.at(5, 2), mark(2, 1, 0));
}

TEST_F(Auxiliary, AnotherFileOfTheSameFrameLiesWhereItsWindowDoes) {
  const auto file = [&](const std::string& name, const Rect& window, const std::vector<std::string>& channels) {
    auto spec = make_spec(window.width, window.height, channels, OIIO::TypeFloat);
    spec.x = window.x;
    spec.y = window.y;
    spec.full_width = spec.full_height = 10;
    make_file(folder_ / name, {spec}, {marks(window.width, window.height, static_cast<int>(channels.size()))});
  };
  ASSERT_NO_FATAL_FAILURE(file("box.exr", {2, 3, 4, 3}, {"R", "G", "B"}));
  ASSERT_NO_FATAL_FAILURE(file("whole.exr", {0, 0, 10, 10}, {"Z"}));
  ASSERT_NO_FATAL_FAILURE(file("beside.exr", {5, 5, 4, 3}, {"Z"}));
  options_.auxiliary = {"depth"};
  options_.depth = {folder_ / "whole.exr", "Z"};
  EXPECT_EQ(*read_or_fail(folder_ / "box.exr", options_).auxiliary.at("depth").at(7, 8), mark(7, 8, 0));
  options_.depth = {folder_ / "beside.exr", "Z"};
  const Picture picture = read_or_fail(folder_ / "box.exr", options_);
  EXPECT_EQ(*picture.auxiliary.at("depth").at(5, 5), mark(0, 0, 0));
  EXPECT_EQ(*picture.auxiliary.at("depth").at(2, 3), 1e10f) << "there is colour, but no depth";
  EXPECT_EQ(picture.color.at(2, 3)[1], mark(0, 0, 1));
}

TEST_F(Auxiliary, BackgroundAndNonFinite) {
  ASSERT_NO_FATAL_FAILURE(make_file(folder_ / "inf.exr",
                                    {make_spec(2, 1, {"R", "G", "B", "Z", "N.X", "N.Y", "N.Z"}, OIIO::TypeFloat)},
                                    {{1, 1, 1, INFINITY, NAN, 0, 1, 1, 1, 1, 5, 0, 0, 1}}));
  Messages messages;
  const auto picture = read_picture(folder_ / "inf.exr", options_, messages.diagnostics);
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture.value().auxiliary.at("depth").pixels, (std::vector<float>{1e10f, 5}));
  EXPECT_EQ(picture.value().auxiliary.at("normal").pixels, (std::vector<float>{0, 0, 0, 0, 0, 1}));
  EXPECT_EQ(messages.warnings.size(), 1u);
}

TEST_F(Auxiliary, NumbersThatDevicesMayTakeForZeroAreZero) {
  ASSERT_NO_FATAL_FAILURE(make_file(folder_ / "small.exr",
                                    {make_spec(2, 1, {"R", "G", "B", "Z", "N.X", "N.Y", "N.Z"}, OIIO::TypeFloat)},
                                    {{1, 1, 1, 1e-39f, 1e-45f, -1e-39f, 1, 1, 1, 1, 2e-38f, 0, -2e-38f, 1}}));
  const auto picture = read_or_fail(folder_ / "small.exr", options_);
  EXPECT_EQ(picture.auxiliary.at("depth").pixels, (std::vector<float>{0, 2e-38f}));
  EXPECT_EQ(picture.auxiliary.at("normal").pixels, (std::vector<float>{0, 0, 1, 0, -2e-38f, 1}));
}

TEST_F(Auxiliary, LayerChoices) {
  const std::string file = (folder_ / "both.exr").string();
  EXPECT_EQ(parse_layer_choice(file).file, file);
  EXPECT_EQ(parse_layer_choice(file).name, "");
  EXPECT_EQ(parse_layer_choice(file + ":near.Z").file, file);
  EXPECT_EQ(parse_layer_choice(file + ":near.Z").name, "near.Z");
  EXPECT_EQ(parse_layer_choice("ViewLayer.Depth.Z").name, "ViewLayer.Depth.Z");
  EXPECT_TRUE(parse_layer_choice("ViewLayer.Depth.Z").file.empty());
  EXPECT_EQ(parse_layer_choice("a/depth.####.exr").file, "a/depth.####.exr");
  EXPECT_EQ(parse_layer_choice("a/depth.%04d.exr:Z").name, "Z");
  EXPECT_EQ(parse_layer_choice("missing.exr:Z").name, "missing.exr:Z");
  std::ofstream(folder_ / "odd:name.exr") << "x";
  EXPECT_EQ(parse_layer_choice((folder_ / "odd:name.exr").string()).name, "");
  EXPECT_EQ(parse_layer_choice((folder_ / "odd:name.exr").string() + ":Z").name, "Z");
  EXPECT_FALSE(parse_layer_choice("").given());
}

}  // namespace
}  // namespace afterglow
