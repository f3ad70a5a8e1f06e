// SPDX-License-Identifier: MIT
// Light to stored values, against the curves in double precision.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "image/output_space.h"

namespace afterglow {
namespace {

class Spaces : public testing::TestWithParam<InputSpace> {};

TEST_P(Spaces, GoThereAndBack) {
  const InputSpace& space = *find_input_space(GetParam().name).value();
  const OutputSpace& out = OutputSpace::of(space);
  const Matrix3 matrix = to_rec709(space.primaries);
  for (int i = 0; i <= 4095; ++i) {
    const double stored = i / 4095.0, other = (4095 - i) / 4095.0;
    double light[3] = {space.to_linear(stored), space.to_linear(other), space.to_linear(stored)};
    if (space.hlg_display) {
      const double luminance = 0.2627 * light[0] + 0.6780 * light[1] + 0.0593 * light[2];
      for (double& channel : light) channel *= std::pow(luminance, 0.2);
    }
    float pixel[4] = {0, 0, 0, 0.25f};
    for (std::size_t c = 0; c < 3; ++c)
      pixel[c] = static_cast<float>(matrix[c][0] * light[0] + matrix[c][1] * light[1] + matrix[c][2] * light[2]);
    // What a float of light cannot tell apart: the largest of the three, in the steepness of the curve.
    const double step = 1e-5, most = std::max({light[0], light[1], 1e-6});
    const auto off = [&](double v) {
      const double slope = (space.to_linear(v + step) - space.to_linear(v)) / step;
      return 3e-6 + most * 4e-7 / std::max(slope, 1e-9);
    };
    out.encode(pixel, 1, pixel);
    ASSERT_NEAR(pixel[0], stored, off(stored)) << i;
    ASSERT_NEAR(pixel[1], other, off(other)) << i;
    ASSERT_EQ(pixel[3], 0.25f);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Spaces, testing::ValuesIn(input_spaces().begin(), input_spaces().end()),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(OutputSpace, HoldsWhatIsBeyond) {
  for (const InputSpace& space : input_spaces()) {
    float pixels[8] = {1e30f, INFINITY, 1e30f, 1, NAN, -3, 0, 1};
    OutputSpace::of(space).encode(pixels, 2, pixels);
    for (const float value : pixels) EXPECT_TRUE(value >= 0 && value <= 1) << space.name << " " << value;
    EXPECT_TRUE(space.primaries.red != kRec709.red || pixels[0] == 1) << space.name;
  }
}

/// Pixels beside each other are made together; alone they are not. Into other memory they are the same too.
TEST(OutputSpace, ManyPixelsAreTheSameBitsAsOne) {
  std::vector<float> light;
  for (const float special : {0.0f, -0.0f, 1e-45f, 1e-38f, 0x1p-40f, 0x1.000002p-40f, 0x1p10f, 1023.99f, 1e30f, -1e30f,
                              INFINITY, -INFINITY, NAN, 1.0f, 0.18f})
    light.insert(light.end(), 4, special);
  for (float value = 0x1p-45f; value < 0x1p14f; value *= 1.0037f) light.push_back(value);
  light.resize(light.size() / 4 * 4);
  for (const InputSpace& space : input_spaces()) {
    const OutputSpace& out = OutputSpace::of(space);
    std::vector<float> together = light, alone = light, elsewhere(light.size());
    out.encode(light.data(), light.size() / 4, elsewhere.data());
    out.encode(together.data(), together.size() / 4, together.data());
    EXPECT_EQ(std::memcmp(elsewhere.data(), together.data(), light.size() * sizeof(float)), 0) << space.name;
    for (std::size_t i = 0; i < alone.size(); i += 4) out.encode(&alone[i], 1, &alone[i]);
    EXPECT_EQ(std::memcmp(together.data(), alone.data(), alone.size() * sizeof(float)), 0) << space.name;
  }
}

TEST(OutputSpace, CineonIsKodaks) {
  const OutputSpace* cineon = find_output_space("cineon").value();
  float pixels[8] = {0, 0.18f, 1, 1, 13.5f, 0, 0, 1};
  cineon->encode(pixels, 2, pixels);
  EXPECT_NEAR(pixels[0] * 1023, 95, 0.01);
  EXPECT_NEAR(pixels[1] * 1023, 685 + 300 * std::log10(0.18 + 0.82 * std::pow(10, -590.0 / 300)), 0.01);
  EXPECT_NEAR(pixels[2] * 1023, 685, 0.01);
  EXPECT_EQ(find_output_space("").value(), nullptr);
  EXPECT_EQ(find_output_space("logc").error().kind, ErrorKind::usage);
  EXPECT_TRUE(
      find_output_space("logc").error().text().starts_with("error: 'logc' is no output space; allowed: aces2065_1"));
}

}  // namespace
}  // namespace afterglow
