// SPDX-License-Identifier: MIT
// Codes whose rounding is spread over neighbouring pixels.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "image/encode.h"
#include "image/output_format.h"
#include "image/output_space.h"
#include "image/srgb.h"
#include "temporary_folder.h"
#include "written_files.h"

namespace afterglow {
namespace {

std::vector<std::uint8_t> codes_of(float light, const CodeRules& rules) {
  const std::vector<float> row(64 * 4, light);
  std::vector<std::uint8_t> codes;
  for (int y = 0; y < 64; ++y) {
    std::array<std::uint8_t, 64 * 3> line{};
    encode_row(rules, row.data(), 64, 0, y, line.data());
    codes.insert(codes.end(), line.begin(), line.end());
  }
  return codes;
}

TEST(Dither, AFlatAreaHasItsLightFromTwoNeighbouringCodes) {
  const CodeRules rules{.dither = true};
  for (float light = 1e-5f; light < 1; light *= 1.07f) {
    const auto codes = codes_of(light, rules);
    const double encoded = linear_to_srgb(light) * 255;
    double sum = 0;
    for (const auto code : codes) {
      ASSERT_LT(std::abs(code - encoded), 1) << light;
      sum += srgb_to_linear(code / 255.0);
    }
    const double step = srgb_to_linear((std::floor(encoded) + 1) / 255) - srgb_to_linear(std::floor(encoded) / 255);
    // In light, not in codes. Between codes 10 and 11 lies the end of the curve's straight part.
    EXPECT_NEAR(sum / static_cast<double>(codes.size()), light, (std::floor(encoded) == 10 ? 0.01 : 0.0025) * step)
        << light;
  }
}

TEST(Dither, CodesStayWhatTheyAre) {
  for (int code = 0; code < 256; ++code) {
    const auto light = static_cast<float>(srgb_to_linear(code / 255.0));
    for (const auto found : codes_of(light, {.dither = true})) ASSERT_EQ(found, code);
  }
  for (const float light : {-1.0f, 2.0f, 1e30f})
    for (const auto found : codes_of(light, {.dither = true})) ASSERT_EQ(found, light < 0 ? 0 : 255);
}

TEST(Dither, CodesOfOtherSpacesStayToo) {
  for (const char* name : {"rec709", "gamma22", "gamma24"}) {
    const InputSpace& space = *find_input_space(name).value();
    for (int code = 0; code < 256; ++code) {
      const auto light = static_cast<float>(space.to_linear(code / 255.0));
      for (const auto found : codes_of(light, {.dither = true, .space = &OutputSpace::of(space)}))
        ASSERT_EQ(found, code) << name;
    }
  }
}

TEST(Dither, NoiseIsBlueAndEven) {
  std::vector<int> count(4096);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) ++count[static_cast<std::size_t>(blue_noise(x, y) * 4096)];
  for (const int times : count) EXPECT_EQ(times, 1);
  EXPECT_EQ(blue_noise(3 + 64, 5 + 128), blue_noise(3, 5));
  // Sums of 8×8 pixels hardly differ, where white noise deviates by 8·√(1/12) = 2.3.
  double variance = 0;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      double sum = -32;
      for (int j = 0; j < 8; ++j)
        for (int i = 0; i < 8; ++i) sum += static_cast<double>(blue_noise(x + i, y + j));
      variance += sum * sum / 4096;
    }
  EXPECT_LT(std::sqrt(variance), 0.8);
}

TEST(Dither, IsForEightBitsUnlessToldOtherwise) {
  EXPECT_TRUE(dithers({}, SampleType::uint8));
  EXPECT_FALSE(dithers({}, SampleType::uint16));
  WriteOptions options;
  options.dither = true;
  EXPECT_TRUE(dithers(options, SampleType::uint16));
  options.dither = false;
  EXPECT_FALSE(dithers(options, SampleType::uint8));
}

}  // namespace
}  // namespace afterglow
