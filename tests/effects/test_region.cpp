// SPDX-License-Identifier: MIT
// A region is the crop of the whole result, bit for bit.
#include <gtest/gtest.h>
#include <unistd.h>

#include <bit>
#include <cstdlib>
#include <fstream>
#include <random>

#include "session/session.h"

namespace afterglow {
namespace {

struct Case {
  const char* name;
  const char* entries;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class RegionOfEffects : public testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    setenv("AFTERGLOW_HOME", AFTERGLOW_PROJECT_FOLDER, 1);
    setenv("XDG_RUNTIME_DIR", testing::TempDir().c_str(), 0);
    std::ofstream(file()) << "local fx = require \"afterglow\"\nreturn fx.stack {" << GetParam().entries << "}\n";
  }
  void TearDown() override { std::filesystem::remove(file()); }
  static std::string file() { return testing::TempDir() + "/afterglow_region_" + std::to_string(getpid()) + ".lua"; }

  static Picture picture(Size size, unsigned seed = 7) {
    Picture out;
    out.color = Image(size.width, size.height, 4);
    out.auxiliary["depth"] = Image(size.width, size.height, 1);
    out.auxiliary["normal"] = Image(size.width, size.height, 3);
    std::mt19937 random(seed);
    const auto fill = [&](Image& image, float scale) {
      for (auto& value : image.pixels) value = scale * static_cast<float>(random() % 1000) / 999.0f;
    };
    fill(out.color, 1.5f);
    fill(out.auxiliary["depth"], 20.0f);
    fill(out.auxiliary["normal"], 1.0f);
    for (int i = 0; i < 12; ++i)
      out.color.at(static_cast<int>(random() % static_cast<unsigned>(size.width)),
                   static_cast<int>(random() % static_cast<unsigned>(size.height)))[i % 3] = 90.0f;
    return out;
  }

  void check(Size size, Precision precision, bool reference) {
    SessionOptions options;
    options.device.validate = true;
    options.stack.precision = precision;
    options.stack.reference = reference;
    Diagnostics diagnostics;
    Picture whole = picture(size);
    {
      const auto other = Session::open(file(), options, diagnostics);
      ASSERT_TRUE(other) << other.error().text();
      ASSERT_TRUE((*other)->process(whole));
    }
    // What is not uploaded for a region is of another picture.
    auto session = Session::open(file(), options, diagnostics);
    ASSERT_TRUE(session) << session.error().text();
    Picture another = picture(size, 99);
    ASSERT_TRUE((*session)->process(another));
    const int w = size.width, h = size.height;
    for (const Rect& part :
         {Rect{w / 3, h / 3, 13, 9}, Rect{0, 0, 1, 1}, Rect{w - 1, h - 1, 1, 1}, Rect{0, h * 2 / 3, w, 1},
          Rect{w - 20, 0, 20, 7}, Rect{w / 2, 0, 1, h}, Rect{0, 0, w, h}}) {
      Picture some = picture(size);
      const auto done = (*session)->process(some, {}, {}, part);
      ASSERT_TRUE(done) << done.error().text();
      int different = 0;
      for (int y = part.y; y < part.y + part.height; ++y)
        for (int x = part.x; x < part.x + part.width; ++x)
          for (int c = 0; c < 4; ++c)
            different += std::bit_cast<std::uint32_t>(some.color.at(x, y)[c]) !=
                         std::bit_cast<std::uint32_t>(whole.color.at(x, y)[c]);
      EXPECT_EQ(different, 0) << part.x << "," << part.y << " " << part.width << "×" << part.height << " of " << w
                              << "×" << h;
    }
    EXPECT_EQ((*session)->device().validation_errors(), 0);
  }
};

TEST_P(RegionOfEffects, IsTheCrop) {
  check({97, 61}, Precision::automatic, false);
  check({128, 64}, Precision::automatic, false);
  check({64, 48}, Precision::fp16, false);
  check({64, 48}, Precision::automatic, true);
}

TEST_P(RegionOfEffects, IsTheCropOfLargePictures) { check({1024, 520}, Precision::automatic, false); }

INSTANTIATE_TEST_SUITE_P(
    , RegionOfEffects,
    testing::Values(
        Case{"Scattering", "fx.bloom { mode = \"scattering\", max_iterations = 16 }, fx.tone_mapping { }"},
        Case{"Fireflies",
             "fx.bloom { fade_fireflies = true, bicubic_upsampling = false }, fx.color_adjustments { contrast = 20 }"},
        Case{"OneLevel", "fx.bloom { max_iterations = 1 }"},
        Case{"BoxBloom", "fx.box_bloom { threshold = 0.5 }, fx.color_blit { intensity = 1.5 }"},
        Case{"Outline", "fx.outline { width = 3.4, contrast = 3 }, fx.bloom { max_iterations = 2 }"},
        Case{"Derivative", "fx.outline { difference = \"derivative\", source = \"depth\" }"}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace afterglow
