// SPDX-License-Identifier: MIT
// Every line of tests/golden_values.txt: values of an independent implementation (math.md §14).
#include <gmock/gmock.h>

#include <fstream>
#include <functional>
#include <map>
#include <sstream>
#include <string>

#include "reference/bloom.h"
#include "reference/color.h"
#include "reference/color_adjustments.h"
#include "reference/tone_mapping.h"

namespace afterglow::reference {
namespace {

Rgb each(const Rgb& c, double (*f)(double)) { return {f(c.r), f(c.g), f(c.b)}; }

const std::map<std::string, std::function<Rgb(const Rgb&)>> kFunctions = {
    {"reinhard", [](const Rgb& c) { return tone_map(c, ToneMode::reinhard); }},
    {"neutral", [](const Rgb& c) { return tone_map(c, ToneMode::neutral); }},
    {"aces", [](const Rgb& c) { return tone_map(c, ToneMode::aces); }},
    {"hsv", [](const Rgb& c) { return rgb_to_hsv(c, kUnityHsvEpsilon); }},
    {"logC", [](const Rgb& c) { return each(c, linear_to_logc); }},
    {"srgb_to_linear", [](const Rgb& c) { return each(c, srgb_to_linear); }},
    {"contrast+50", [](const Rgb& c) { return adjust_contrast(c, 1.5); }},
    {"hue+60", [](const Rgb& c) { return shift_hue(c, 60.0 / 360); }},
    {"sat+50", [](const Rgb& c) { return adjust_saturation(c, 1.5); }},
    {"thresh 1/.5",
     [](const Rgb& c) {
       return BloomThreshold{1, 0.5}(c);
     }},
};

TEST(Golden, EveryLineIsReproduced) {
  std::ifstream file(AFTERGLOW_TEST_FOLDER "/golden_values.txt");
  ASSERT_TRUE(file);
  int lines = 0;
  for (std::string line; std::getline(file, line); ++lines) {
    const std::string name = line.substr(0, line.find_last_not_of(' ', 14) + 1);
    char comma;
    Rgb in, expected;
    std::string arrow;
    std::istringstream(line.substr(15)) >> in.r >> comma >> in.g >> comma >> in.b >> arrow >> expected.r >>
        expected.g >> expected.b;
    ASSERT_EQ(arrow, "->") << line;
    const auto function = kFunctions.find(name);
    ASSERT_NE(function, kFunctions.end()) << "'" << name << "'";
    const Rgb got = function->second(in);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], expected[c], 5.1e-11) << line;
  }
  EXPECT_EQ(lines, 120);
}

TEST(Golden, Table14) {
  const auto threshold = BloomThreshold{1, 0.5};
  EXPECT_NEAR(threshold(Rgb(8, 0.5, 0.1)).g, 0.4375, 1e-12);
  EXPECT_EQ(threshold(Rgb(0.5)), Rgb(0));
  EXPECT_NEAR(adjust_contrast(Rgb(0), 1.5).r, -0.0069771782, 5e-11);
  EXPECT_NEAR(tone_map(Rgb(1000), ToneMode::aces).r, 0.9453927501, 5e-11) << "clamped to 60 first";
  EXPECT_EQ(tone_map(Rgb(1000), ToneMode::none), Rgb(1000)) << "none does not clamp";
}

}  // namespace
}  // namespace afterglow::reference
