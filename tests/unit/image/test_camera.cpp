// SPDX-License-Identifier: MIT
// The camera's place from worldToCamera.
#include <gtest/gtest.h>

#include <cmath>

#include "image/metadata.h"

namespace afterglow {
namespace {

Metadata with(std::vector<float> matrix) { return {{"worldToCamera", std::move(matrix)}}; }

TEST(Camera, StandsWhereItsOwnSpaceBegins) {
  // Row vectors: a quarter turn about y and then a shift by (1, 2, 3). The camera's axes lie along −z, y, x of the
  // world, so it stands at (−3, −2, 1): (−3, −2, 1) · A = (−1, −2, −3).
  const auto position = camera_position(with({0, 0, 1, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 2, 3, 1}));
  ASSERT_TRUE(position);
  EXPECT_EQ((*position)[0], -3);
  EXPECT_EQ((*position)[1], -2);
  EXPECT_EQ((*position)[2], 1);
}

TEST(Camera, ScaleDoesNotMatter) {
  const auto position = camera_position(with({2, 0, 0, 0, 0, 2, 0, 0, 0, 0, -2, 0, -10, 4, 6, 1}));
  ASSERT_TRUE(position);
  EXPECT_EQ(*position, (std::array<double, 3>{5, -2, 3}));
}

TEST(Camera, NothingThatIsNoCamera) {
  EXPECT_FALSE(camera_position({}));
  EXPECT_FALSE(camera_position(with({1, 0, 0})));
  EXPECT_FALSE(camera_position(with(std::vector<float>(16, 0))));
  std::vector<float> bad{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, NAN, 0, 1};
  EXPECT_FALSE(camera_position(with(bad)));
  EXPECT_FALSE(camera_position({{"worldToCamera", std::string("here")}}));
}

}  // namespace
}  // namespace afterglow
