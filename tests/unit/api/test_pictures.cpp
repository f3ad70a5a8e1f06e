// SPDX-License-Identifier: MIT
// Pictures in host memory, in every form: the same pixels as a Session makes.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/half.h"
#include "fixture.h"
#include "image/reader.h"
#include "image/writer.h"
#include "session/session.h"

namespace afterglow::test {
namespace {

constexpr int kWidth = 37, kHeight = 21;

class PictureTest : public ApiTest {
 protected:
  void SetUp() override {
    ApiTest::SetUp();
    look("fx.bloom { mode = \"scattering\", threshold = 0.5 }, fx.gain { amount = 2 }");
  }

  /// What a Session makes of it.
  Picture expected(const std::vector<float>& pixels, const std::optional<DisplayEncoding>& encoding = {}) const {
    Diagnostics diagnostics;
    auto session = Session::open(file("look.lua"), {}, diagnostics);
    EXPECT_TRUE(session) << session.error().text();
    Picture picture;
    picture.color = Image(kWidth, kHeight, 4);
    picture.color.pixels = pixels;
    const auto done = (*session)->process(picture, {}, encoding);
    EXPECT_TRUE(done) << done.error().text();
    return picture;
  }

  static void run(const StackPtr& stack, const afterglow_image& source, const afterglow_image& result) {
    afterglow_run_info info = afterglow_run_info_default();
    info.source = source;
    info.result = result;
    ASSERT_TRUE(fine(afterglow_stack_run(stack.get(), &info)));
  }
};

TEST_F(PictureTest, FloatsAreThoseOfASession) {
  std::vector<float> source = pixels(kWidth, kHeight), result(source.size());
  const std::vector<float> before = source;
  const Picture wanted = expected(source);
  const StackPtr stack = this->stack();
  run(stack, image(source, kWidth, kHeight), image(result, kWidth, kHeight));
  EXPECT_EQ(result, wanted.color.pixels);
  EXPECT_EQ(source, before);
  // The source may be the result.
  run(stack, image(source, kWidth, kHeight), image(source, kWidth, kHeight));
  EXPECT_EQ(source, wanted.color.pixels);
}

/// It is of files; what a host hands over is what afterglow.h says.
TEST_F(PictureTest, TheInputSpaceOfALookIsToldToBeOfFiles) {
  std::vector<float> source = pixels(kWidth, kHeight), result(source.size()), plain(source.size());
  look("fx.gain { amount = 2 }");
  run(stack(), image(source, kWidth, kHeight), image(plain, kWidth, kHeight));
  look("input_space = \"logc3\", fx.gain { amount = 2 }");
  const StackPtr stack = this->stack(listening());
  for (int i = 0; i < 2; ++i) run(stack, image(source, kWidth, kHeight), image(result, kWidth, kHeight));
  EXPECT_EQ(result, plain);
  EXPECT_THAT(messages_, testing::ElementsAre(HasSubstr("input_space = \"logc3\" of the look is for files")));
}

TEST_F(PictureTest, ComponentsBelowZeroStayWhereTheLookSaysSo) {
  std::vector<float> source = pixels(kWidth, kHeight), result(source.size());
  source[4] = -0.25f;
  look("gamut = \"keep\", fx.gain { amount = 2 }");
  run(stack(), image(source, kWidth, kHeight), image(result, kWidth, kHeight));
  EXPECT_EQ(result[4], -0.5f);
  look("fx.gain { amount = 2 }");
  run(stack(), image(source, kWidth, kHeight), image(result, kWidth, kHeight));
  EXPECT_EQ(result[4], 0);
}

TEST_F(PictureTest, ThreeChannelsAreOpaque) {
  std::vector<float> opaque = pixels(kWidth, kHeight), three;
  for (std::size_t i = 0; i < opaque.size(); ++i) {
    if (i % 4 == 3)
      opaque[i] = 1;
    else
      three.push_back(opaque[i]);
  }
  const Picture wanted = expected(opaque);
  std::vector<float> result(three.size());
  const StackPtr stack = this->stack();
  run(stack, image(three, kWidth, kHeight, 3), image(result, kWidth, kHeight, 3));
  for (std::size_t i = 0; i < result.size(); ++i) ASSERT_EQ(result[i], wanted.color.pixels[i / 3 * 4 + i % 3]) << i;
  std::vector<float> four(opaque.size());
  run(stack, image(three, kWidth, kHeight, 3), image(four, kWidth, kHeight));
  EXPECT_EQ(four, wanted.color.pixels);
}

TEST_F(PictureTest, StridesAreKeptAndGapsLeftAlone) {
  const std::vector<float> source = pixels(kWidth, kHeight);
  const Picture wanted = expected(source);
  constexpr int kPixel = 6, kRow = kWidth * kPixel + 5;  // floats
  std::vector<float> spread(static_cast<std::size_t>(kRow) * kHeight, -7), result(spread);
  const auto at = [&](std::vector<float>& all, int x, int y) {  // the last row comes first
    return &all[static_cast<std::size_t>((kHeight - 1 - y) * kRow + x * kPixel)];
  };
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      std::memcpy(at(spread, x, y), &source[static_cast<std::size_t>(y * kWidth + x) * 4], 16);
  const auto view = [&](std::vector<float>& all) {
    return afterglow_image{at(all, 0, 0), kWidth, kHeight, 4, AFTERGLOW_FLOAT, -kRow * 4, kPixel * 4};
  };
  run(this->stack(), view(spread), view(result));
  std::size_t touched = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      ASSERT_EQ(0,
                std::memcmp(at(result, x, y), &wanted.color.pixels[static_cast<std::size_t>(y * kWidth + x) * 4], 16))
          << x << " " << y;
  for (const float value : result) touched += value != -7;
  EXPECT_EQ(touched, source.size());
}

TEST_F(PictureTest, StridesShorterThanWhatTheyStepOverAreErrors) {
  std::vector<float> source = pixels(kWidth, kHeight), result(source.size());
  const std::vector<float> before = result;
  const StackPtr stack = this->stack();
  constexpr std::ptrdiff_t kRow = kWidth * 16, kFar = std::numeric_limits<std::ptrdiff_t>::max();
  const auto refused = [&](std::ptrdiff_t row, std::ptrdiff_t pixel) {
    std::string texts;
    for (const bool of_result : {false, true}) {
      afterglow_run_info info = afterglow_run_info_default();
      info.source = image(source, kWidth, kHeight);
      info.result = image(result, kWidth, kHeight);
      afterglow_image& image = of_result ? info.result : info.source;
      image.row_stride = row;
      image.pixel_stride = pixel;
      const ErrorPtr error(afterglow_stack_run(stack.get(), &info));
      EXPECT_EQ(afterglow_error_get_kind(error.get()), AFTERGLOW_ERROR_USAGE) << row << " " << pixel;
      texts += text_of(error.get()) + "\n";
    }
    return texts;
  };
  for (const std::ptrdiff_t row : {kRow - 1, std::ptrdiff_t{1}, std::ptrdiff_t{-1}, 1 - kRow})
    EXPECT_EQ(refused(row, 0),
              "error: image 'source': row_stride is less than a row\n"
              "error: image 'result': row_stride is less than a row\n");
  EXPECT_THAT(refused(kRow, 15), HasSubstr("image 'source': pixel_stride is less than 16 bytes"));
  EXPECT_THAT(refused(kRow, -16), HasSubstr("image 'result': pixel_stride is less than 16 bytes"));
  for (const auto& [row, pixel] : {std::pair{kFar, std::ptrdiff_t{0}}, {-kFar - 1, 0}, {0, kFar}, {kRow, kFar / 2}})
    EXPECT_THAT(refused(row, pixel), HasSubstr("a stride is more than 2^46 bytes"));
  EXPECT_EQ(result, before);
}

TEST_F(PictureTest, HalvesAreReadAndWritten) {
  std::vector<float> source = pixels(kWidth, kHeight);
  std::vector<std::uint16_t> halves(source.size()), result(source.size()), rounded(source.size());
  halves_from_floats(source.data(), source.size(), halves.data());
  floats_from_halves(halves.data(), halves.size(), source.data());
  const Picture wanted = expected(source);
  halves_from_floats(wanted.color.pixels.data(), rounded.size(), rounded.data());
  run(this->stack(), {halves.data(), kWidth, kHeight, 4, AFTERGLOW_HALF, 0, 0},
      {result.data(), kWidth, kHeight, 4, AFTERGLOW_HALF, 0, 0});
  EXPECT_EQ(result, rounded);
}

TEST_F(PictureTest, CodesAreThoseOfAFile) {
  std::vector<std::uint8_t> codes(static_cast<std::size_t>(kWidth) * kHeight * 4), result(codes.size());
  for (std::size_t i = 0; i < codes.size(); ++i) codes[i] = static_cast<std::uint8_t>(i * 7 % 256);
  Picture written;
  written.color = Image(kWidth, kHeight, 4);
  written.unorm8.assign(codes.begin(), codes.end());
  written.has_alpha = true;
  written.data_window = written.display_window = {0, 0, kWidth, kHeight};
  Diagnostics diagnostics;
  ASSERT_TRUE(write_picture(written, file("codes.png"), {}, diagnostics));
  const auto read = read_picture(file("codes.png"), {}, diagnostics);
  ASSERT_TRUE(read) << read.error().text();
  const Picture wanted = expected(read->color.pixels, DisplayEncoding{.straight_alpha = true});
  ASSERT_FALSE(wanted.unorm8.empty());
  const StackPtr stack = this->stack();
  run(stack, {codes.data(), kWidth, kHeight, 4, AFTERGLOW_UINT8, 0, 0},
      {result.data(), kWidth, kHeight, 4, AFTERGLOW_UINT8, 0, 0});
  EXPECT_TRUE(std::ranges::equal(result, wanted.unorm8));

  // To floats, and in three channels.
  const Picture linear = expected(read->color.pixels);
  std::vector<float> floats(codes.size());
  run(stack, {codes.data(), kWidth, kHeight, 4, AFTERGLOW_UINT8, 0, 0}, image(floats, kWidth, kHeight));
  EXPECT_EQ(floats, linear.color.pixels);
}

TEST_F(PictureTest, ALookThatDoesNothingHandsThePictureOver) {
  look("fx.gain { off = true }");
  std::vector<float> source = pixels(kWidth, kHeight), result(source.size());
  const StackPtr stack = this->stack();
  run(stack, image(source, kWidth, kHeight), image(result, kWidth, kHeight));
  EXPECT_EQ(result, source);
  EXPECT_FALSE(afterglow_stack_runs(stack.get()));
  std::vector<std::uint8_t> codes(source.size() / 4 * 3);
  source.assign(source.size(), 1.0f);
  run(stack, image(source, kWidth, kHeight), {codes.data(), kWidth, kHeight, 3, AFTERGLOW_UINT8, 0, 0});
  EXPECT_EQ(codes, std::vector<std::uint8_t>(codes.size(), 255));
}

TEST_F(PictureTest, OnlyTheRegionIsWritten) {
  std::vector<float> source = pixels(kWidth, kHeight), result(source.size(), -7);
  const Picture wanted = expected(source);
  const StackPtr stack = this->stack();
  afterglow_run_info info = afterglow_run_info_default();
  info.source = image(source, kWidth, kHeight);
  info.result = image(result, kWidth, kHeight);
  info.region = {5, 3, 11, 9};
  ASSERT_TRUE(fine(afterglow_stack_run(stack.get(), &info)));
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const bool inside = x >= 5 && x < 16 && y >= 3 && y < 12;
      const std::size_t i = static_cast<std::size_t>(y * kWidth + x) * 4;
      for (std::size_t c = 0; c < 4; ++c)
        ASSERT_EQ(result[i + c], inside ? wanted.color.pixels[i + c] : -7) << x << " " << y;
    }
  info.region = {30, 0, 8, 1};
  const ErrorPtr outside(afterglow_stack_run(stack.get(), &info));
  EXPECT_EQ(afterglow_error_get_kind(outside.get()), AFTERGLOW_ERROR_USAGE);
}

TEST_F(PictureTest, WhatIsNotFiniteIsMendedAndTold) {
  look("fx.gain { amount = 2 }");
  const StackPtr stack = this->stack(listening());
  std::vector<float> source(4 * 4, 0.5f), result(source.size());
  source[0] = std::numeric_limits<float>::quiet_NaN();
  source[1] = -1;
  source[7] = std::numeric_limits<float>::infinity();  // an alpha
  for (int i = 0; i < 2; ++i) run(stack, image(source, 2, 2), image(result, 2, 2));
  EXPECT_EQ(result[0], 0);
  EXPECT_EQ(result[1], 0);
  EXPECT_EQ(result[2], 1);
  EXPECT_EQ(result[7], 1);
  EXPECT_EQ(json_of(afterglow_stack_report, stack.get())["mended_samples"], 3);
  ASSERT_EQ(messages_.size(), 1u);
  EXPECT_THAT(messages_[0], HasSubstr("3 samples"));
}

TEST_F(PictureTest, EachImageThatIsMendedIsNamed) {
  write("effects/all.lua", R"(
    local fx = require "afterglow"
    return fx.effect {
      name = "all", doc = "Reads everything.", at = "post_process", order = 0, needs = { "depth", "normal", "motion" },
      settings = {},
      build = function(g, s, source)
        return g:pass { shader = "gain/all", source = source, depth = g:input("depth"), normal = g:input("normal"),
                        motion = g:input("motion") }
      end,
    })");
  write("shaders/gain/all.glsl",
        "uniform sampler2D source;\nuniform sampler2D depth;\nuniform sampler2D normal;\nuniform sampler2D motion;\n"
        "vec4 sample_at(ivec2 pixel) { return fetch(source, pixel) + vec4(min(fetch(depth, pixel).r, 1.0), "
        "fetch(normal, pixel).r, fetch(motion, pixel).r, 0); }\n");
  look("fx.all {}");
  const StackPtr stack = this->stack(listening());
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  std::vector<float> source(4 * 4, 0.5f), result(source.size()), depth(4, 1), normal(4 * 4, 0), motion(4 * 4, 0);
  depth[0] = depth[1] = depth[2] = kNan;
  normal[1] = normal[5] = kNan;
  motion[0] = kNan;
  afterglow_run_info info = afterglow_run_info_default();
  info.source = image(source, 2, 2);
  info.result = image(result, 2, 2);
  info.depth = image(depth, 2, 2, 1);
  info.normal = image(normal, 2, 2);  // more channels than are read may lie beside each other
  info.motion = image(motion, 2, 2);
  for (int i = 0; i < 2; ++i) ASSERT_TRUE(fine(afterglow_stack_run(stack.get(), &info)));
  EXPECT_EQ(result[0], 1.5f);
  EXPECT_EQ(json_of(afterglow_stack_report, stack.get())["mended_samples"], 6);
  EXPECT_THAT(messages_,
              testing::ElementsAre(HasSubstr("image 'depth' has 3 pixels"), HasSubstr("image 'normal' has 2 pixels"),
                                   HasSubstr("image 'motion' has 1 pixels")));
  source[0] = -1;
  ASSERT_TRUE(fine(afterglow_stack_run(stack.get(), &info)));
  ASSERT_EQ(messages_.size(), 4u);
  EXPECT_THAT(messages_[3], HasSubstr("the source has 1 samples"));
}

TEST_F(PictureTest, DepthIsReadWhereALookNeedsIt) {
  look("fx.fog {}");
  const StackPtr stack = this->stack();
  std::vector<float> source(2 * 2 * 4, 0.5f), result(source.size());
  std::vector<std::uint16_t> depth(4, half_from_float(3));
  afterglow_run_info info = afterglow_run_info_default();
  info.source = image(source, 2, 2);
  info.result = image(result, 2, 2);
  info.depth = {depth.data(), 2, 2, 1, AFTERGLOW_HALF, 0, 0};
  ASSERT_TRUE(fine(afterglow_stack_run(stack.get(), &info)));
  EXPECT_EQ(result[0], 3.5f);
  EXPECT_EQ(result[3], 0.5f);

  info.depth = {};
  ASSERT_TRUE(fine(afterglow_stack_run(stack.get(), &info)));
  EXPECT_EQ(result, source);
  const auto skipped = json_of(afterglow_stack_report, stack.get())["skipped"];
  ASSERT_EQ(skipped.size(), 1u);
  EXPECT_THAT(skipped[0]["reason"].get<std::string>(), HasSubstr("depth"));

  info.depth = {depth.data(), 1, 2, 1, AFTERGLOW_HALF, 0, 0};
  const ErrorPtr small(afterglow_stack_run(stack.get(), &info));
  EXPECT_THAT(text_of(small.get()), HasSubstr("image 'depth' has 1×2 pixels, the source 2×2"));
  info.depth = {depth.data(), 2, 2, 3, AFTERGLOW_HALF, 0, 0};
  const ErrorPtr channels(afterglow_stack_run(stack.get(), &info));
  EXPECT_THAT(text_of(channels.get()), HasSubstr("3 channels; allowed: 1"));
}

TEST_F(PictureTest, HalfStorageKeepsAlphaExactly) {
  afterglow_stack_options options = afterglow_stack_options_default();
  options.precision = AFTERGLOW_PRECISION_FP16;
  std::vector<float> source = pixels(kWidth, kHeight), result(source.size());
  run(this->stack(options), image(source, kWidth, kHeight), image(result, kWidth, kHeight));
  for (std::size_t i = 3; i < source.size(); i += 4) ASSERT_EQ(result[i], source[i]);
}

TEST_F(PictureTest, SidesHaveALimitWhateverRuns) {
  for (const char* entries : {"fx.gain {}", ""}) {
    look(entries);
    const StackPtr stack = this->stack();
    afterglow_shape shape = afterglow_shape_default();
    shape.width = 100000;
    shape.height = 10;
    const ErrorPtr prepared(afterglow_stack_prepare(stack.get(), &shape, nullptr));
    EXPECT_EQ(afterglow_error_get_kind(prepared.get()), AFTERGLOW_ERROR_USAGE);
    EXPECT_THAT(text_of(prepared.get()), HasSubstr("100000×10 pixels; sides go from 1 to 16384"));
    std::vector<float> row = pixels(16385, 1);
    afterglow_run_info info = afterglow_run_info_default();
    info.source = info.result = image(row, 16385, 1);
    const ErrorPtr run(afterglow_stack_run(stack.get(), &info));
    EXPECT_EQ(afterglow_error_get_kind(run.get()), AFTERGLOW_ERROR_USAGE);
    EXPECT_THAT(text_of(run.get()), HasSubstr("image 'source': 16385×1 pixels"));
  }
}

}  // namespace
}  // namespace afterglow::test
