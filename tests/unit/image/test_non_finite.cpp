// SPDX-License-Identifier: MIT
// Values that are not finite: found where they are, and replaced by what is around them.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "image/non_finite.h"

namespace afterglow {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

Image ramp(int width, int height, int channels) {
  Image image(width, height, channels);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = static_cast<float>(i % 97);
  return image;
}

TEST(NonFinite, FindsAllAndTheFirstInRowOrder) {
  Image image = ramp(700, 600, 4);  // large enough for threads
  EXPECT_EQ(find_non_finite(image).count(), 0u);
  EXPECT_FALSE(find_non_finite(image).first);
  image.at(3, 599)[0] = kNan;
  image.at(699, 20)[3] = -kInf;
  image.at(5, 20)[1] = kInf;
  image.at(5, 20)[2] = -kNan;
  const NonFinite found = find_non_finite(image);
  EXPECT_EQ(found.nan, 2u);
  EXPECT_EQ(found.plus_infinity, 1u);
  EXPECT_EQ(found.minus_infinity, 1u);
  EXPECT_EQ(found.text(), "2 NaN, 1 +Inf, 1 -Inf");
  ASSERT_TRUE(found.first);
  EXPECT_EQ(found.first->text().substr(0, 11), "pixel 5,20:");
  EXPECT_TRUE(std::isinf(found.first->values[1]));
}

TEST(NonFinite, TheSmallestSquareThatHasOneStandsIn) {
  Image image(11, 11, 2);
  for (int y = 0; y < 11; ++y)
    for (int x = 0; x < 11; ++x) image.at(x, y)[0] = static_cast<float>(10 * y + x), image.at(x, y)[1] = 7;
  // 3×3 around (5, 5): its centre has none at distance 1 and sixteen at 2, whose mean is its own value.
  for (int y = 4; y <= 6; ++y)
    for (int x = 4; x <= 6; ++x) image.at(x, y)[0] = x == 4 ? kNan : kInf;
  Image mended = image;
  repair_from_neighbours(mended);
  EXPECT_FLOAT_EQ(mended.at(5, 5)[0], 55);
  EXPECT_FLOAT_EQ(mended.at(4, 4)[0], (33 + 34 + 35 + 43 + 53) / 5.0f) << "not of what was replaced";
  EXPECT_EQ(mended.at(5, 5)[1], 7) << "channels by themselves";
  EXPECT_EQ(mended.at(3, 3)[0], 33);
}

TEST(NonFinite, TooFarFromAnythingIsZero) {
  Image image(9, 9, 1);
  for (float& value : image.pixels) value = kNan;
  image.at(0, 0)[0] = 3;
  repair_from_neighbours(image);
  EXPECT_EQ(image.at(4, 4)[0], 3) << "4 pixels away";
  EXPECT_EQ(image.at(5, 0)[0], 0) << "5 pixels away";
}

}  // namespace
}  // namespace afterglow
