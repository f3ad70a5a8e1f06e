// SPDX-License-Identifier: MIT
// Motion vectors: under which names they are found, and that they come out as pixels a frame with y down.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "image/layers.h"
#include "make_files.h"
#include "temporary_folder.h"

namespace afterglow {
namespace {

using Names = std::vector<std::string>;

Names motion_of(const Names& channels, const std::string& name = "") {
  FilePart part;
  part.channels = channels;
  const auto found = find_motion({part}, name, nullptr);
  Names names;
  if (found && found.value())
    for (const int c : found.value()->channels) names.push_back(channels[static_cast<std::size_t>(c)]);
  return names;
}

TEST(Motion, UsualNames) {
  using testing::ElementsAre;
  EXPECT_THAT(motion_of({"V.Combined.R", "V.Vector.W", "V.Vector.X", "V.Vector.Y", "V.Vector.Z"}),
              ElementsAre("V.Vector.X", "V.Vector.Y", "V.Vector.Z", "V.Vector.W"));
  EXPECT_THAT(motion_of({"R", "G", "B", "motion.x", "motion.y"}), ElementsAre("motion.x", "motion.y"));
  EXPECT_THAT(motion_of({"R", "G", "B", "MotionVectors.R", "MotionVectors.G", "MotionVectors.B"}),
              ElementsAre("MotionVectors.R", "MotionVectors.G"));
  EXPECT_THAT(motion_of({"R", "G", "B", "forward.u", "forward.v"}), ElementsAre("forward.u", "forward.v"));
  EXPECT_THAT(motion_of({"R", "G", "B", "velocity.X", "velocity.Y", "velocity.Z"}),
              ElementsAre("velocity.X", "velocity.Y"));
  EXPECT_THAT(motion_of({"R", "G", "B", "Z", "N.X", "N.Y", "N.Z"}), ElementsAre());
  EXPECT_THAT(motion_of({"R", "G", "B", "shift.X", "shift.Y"}, "shift"), ElementsAre("shift.X", "shift.Y"));
  EXPECT_THAT(motion_of({"R", "G", "B", "A", "V.Vector.X", "V.Vector.Y", "V.Vector.Z", "V.Vector.W"}).size(), 4u);
}

TEST(Motion, VectorsAreNoColourAndNoDepth) {
  FilePart part;
  part.channels = {"Vector.W", "Vector.X", "Vector.Y", "Vector.Z"};
  EXPECT_FALSE(find_color({part}, ""));
  EXPECT_FALSE(find_depth({part}, "", nullptr).value());
  EXPECT_FALSE(find_normal({part}, "", nullptr).value());
}

/// Motion of pixel (0, 0) in a file with these channels and values.
std::pair<float, float> read_motion(const Names& channels, const std::vector<float>& values) {
  const TemporaryFolder folder;
  Names all{"R", "G", "B"};
  all.insert(all.end(), channels.begin(), channels.end());
  std::vector<float> pixel{0.1f, 0.2f, 0.3f};
  pixel.insert(pixel.end(), values.begin(), values.end());
  make_file(folder / "motion.exr", {make_spec(1, 1, all, OIIO::TypeFloat)}, {pixel});
  ReadOptions options;
  options.auxiliary = {"motion"};
  const Picture picture = read_or_fail(folder / "motion.exr", options);
  const auto found = picture.auxiliary.find("motion");
  if (found == picture.auxiliary.end() || found->second.channels != 2) return {-1, -1};
  return {found->second.at(0, 0)[0], found->second.at(0, 0)[1]};
}

TEST(Motion, YPointsDown) { EXPECT_EQ(read_motion({"motion.x", "motion.y"}, {3, 4}), std::pair(3.0f, -4.0f)); }

TEST(Motion, FourChannelsAreAveragedWhicheverWayTheyPoint) {
  const Names vector{"Vector.X", "Vector.Y", "Vector.Z", "Vector.W"};
  EXPECT_EQ(read_motion(vector, {3, 4, 5, 2}), std::pair(4.0f, -3.0f));
  EXPECT_EQ(read_motion(vector, {3, 4, -5, -2}), std::pair(4.0f, -3.0f));
  EXPECT_EQ(read_motion(vector, {0, 0, 2, 0}), std::pair(1.0f, -0.0f));
}

TEST(Motion, WhatIsNotFiniteDoesNotMove) {
  const float nan = std::nanf(""), inf = INFINITY;
  EXPECT_EQ(read_motion({"motion.x", "motion.y"}, {nan, inf}), std::pair(0.0f, -0.0f));
  EXPECT_EQ(read_motion({"motion.x", "motion.y"}, {1e30f, -1e30f}), std::pair(16384.0f, 16384.0f));
}

}  // namespace
}  // namespace afterglow
