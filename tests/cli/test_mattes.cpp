// SPDX-License-Identifier: MIT
// Mattes that come as channels and files: which channel is taken, and what is told where it is not there.
#include <OpenImageIO/imageio.h>

#include <functional>

#include "cli_test.h"

namespace afterglow::test {
namespace {

constexpr int kWidth = 8, kHeight = 4;
constexpr float kLight = 0.5F;

class Mattes : public CliTest {
 protected:
  static float matte(int x) { return static_cast<float>(x) / kWidth; }
  using Attributes = std::vector<std::pair<std::string, std::string>>;
  /// `value(channel, x)` in every row.
  template <class Value>
  void make(const std::string& name, const std::vector<std::string>& channels, const Value& value,
            const Attributes& attributes = {}) const {
    OIIO::ImageSpec spec(kWidth, kHeight, static_cast<int>(channels.size()), OIIO::TypeFloat);
    spec.channelnames = channels;
    for (const auto& [key, text] : attributes) spec.attribute(key, text);
    std::vector<float> samples;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        for (const std::string& channel : channels) samples.push_back(value(channel, x));
    auto out = OIIO::ImageOutput::create(text(name));
    ASSERT_TRUE(out && out->open(text(name), spec) && out->write_image(OIIO::TypeFloat, samples.data()) &&
                out->close());
  }
  /// Twice the light where the mask is 1.
  Outcome run_mask(const std::string& mask, const std::string& picture = "a.exr") const {
    write("look.lua",
          "local fx = require \"afterglow\"\nreturn fx.stack { fx.exposure { ev = 1, mask = " + mask + " } }\n");
    const Outcome outcome = run({"run", "look.lua", picture, "-o", "o.exr", "--type", "float"});
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    return outcome;
  }
  /// The mask of a column, by what was made of the light.
  std::vector<float> made() const {
    const auto pixels = pixels_of("o.exr");
    std::vector<float> out;
    for (std::size_t x = 0; x < kWidth && pixels.size() >= 3 * kWidth; ++x) out.push_back(pixels[3 * x] / kLight - 1);
    return out;
  }
  void expect_mask(const std::function<float(int)>& wanted, const std::string& what) const {
    const auto is = made();
    ASSERT_EQ(is.size(), static_cast<std::size_t>(kWidth));
    for (int x = 0; x < kWidth; ++x) ASSERT_NEAR(is[static_cast<std::size_t>(x)], wanted(x), 1e-5) << what << ", " << x;
  }
};

TEST_F(Mattes, ALonelyAlphaIsAlpha) {
  const auto value = [](const std::string& channel, int x) {
    if (channel.size() == 1 && channel != "A") return kLight;
    return channel == "wide.R" ? 0.25F : matte(x);
  };
  make("a.exr", {"R", "G", "B", "matte.A", "wide.R", "wide.A"}, value);
  make("roto.exr", {"A"}, value);
  make("plain.exr", {"R", "G", "B"}, value);
  for (const char* channel : {"a", "r", "luma"})
    for (const char* mask : {"file { file = \"roto.exr\"", "layer { layer = \"matte\""}) {
      const std::string text = std::string("fx.mask.") + mask + ", channel = \"" + channel + "\" }";
      EXPECT_THAT(run_mask(text).err, Not(HasSubstr("warning"))) << text;
      expect_mask(matte, text);
    }
  run_mask("fx.mask.layer { layer = \"wide\", channel = \"a\" }");
  expect_mask(matte, "beside one other");
  run_mask("fx.mask.layer { layer = \"wide\" }");
  expect_mask([](int) { return 0.25F; }, "the other");
  EXPECT_THAT(run_mask("fx.mask.file { file = \"plain.exr\", channel = \"a\" }").err,
              HasSubstr("plain.exr has no alpha; it counts as 1 everywhere"));
  EXPECT_THAT(run_mask("fx.mask.file { file = \"plain.exr\" }").err, Not(HasSubstr("warning")));
}

}  // namespace
}  // namespace afterglow::test
