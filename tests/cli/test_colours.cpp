// SPDX-License-Identifier: MIT
// What colours of files mean that say it in their own ways, and what is told of those that Rec.709 does not have.
#include <OpenImageIO/imageio.h>

#include <algorithm>

#include "cli_test.h"

namespace afterglow::test {
namespace {

class Colours : public CliTest {
 protected:
  using Pixel = std::vector<float>;

  void SetUp() override {
    CliTest::SetUp();
    write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { name = \"nothing\" }\n");
  }
  void make(const std::string& name, OIIO::ImageSpec spec, const std::vector<float>& color) const {
    std::vector<float> pixels;
    for (int i = 0; i < spec.width * spec.height; ++i) pixels.insert(pixels.end(), color.begin(), color.end());
    const auto output = OIIO::ImageOutput::create(name);
    ASSERT_TRUE(output && output->open(text(name), spec));
    ASSERT_TRUE(output->write_image(OIIO::TypeFloat, pixels.data()) && output->close());
  }
  /// The first pixel, and what was said.
  Pixel read_as_light(const std::string& name, std::string* said = nullptr) const {
    const Outcome outcome = run({"run", "look.lua", name, "-o", "light.exr", "--type", "float"});
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    if (said) *said = outcome.err;
    Pixel all = pixels_of("light.exr");
    all.resize(3);
    return all;
  }
};

TEST_F(Colours, OutsideRec709AreTold) {
  OIIO::ImageSpec spec(64, 64, 3, OIIO::TypeFloat);
  const float acescg[8] = {0.713f, 0.293f, 0.165f, 0.830f, 0.128f, 0.044f, 0.32168f, 0.33767f};
  spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), acescg);
  ASSERT_NO_FATAL_FAILURE(make("a.1.exr", spec, {1, 0, 0}));
  ASSERT_NO_FATAL_FAILURE(make("a.2.exr", spec, {1, 0, 0}));
  const Outcome outcome = run({"run", "look.lua", "a.#.exr", "-o", "b.#.exr"});
  EXPECT_EQ(outcome.exit_code, kDone);
  EXPECT_THAT(outcome.err,
              ContainsRegex("a\\.[12]\\.exr: 8192 samples are of colours outside Rec\\.709; they end at 0"));
  EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
  std::string said;
  ASSERT_NO_FATAL_FAILURE(make("in.exr", spec, {0.5f, 0.4f, 0.4f}));
  read_as_light("in.exr", &said);
  EXPECT_THAT(said, IsEmpty());
}

}  // namespace
}  // namespace afterglow::test
