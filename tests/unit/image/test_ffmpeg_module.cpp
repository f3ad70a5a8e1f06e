// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstdio>

#include "image/ffmpeg_module.h"

namespace afterglow {
namespace {

/// FFmpeg 5.1 to 7.1: libavformat 59 to 61.
TEST(FfmpegModule, IsLoadedWhenItIsAskedFor) {
  const auto module = ffmpeg_module();
  ASSERT_TRUE(module) << module.error().text();
  int major = 0;
  ASSERT_EQ(std::sscanf((*module)->version().c_str(), "libavformat %d.", &major), 1) << (*module)->version();
  EXPECT_GE(major, 59);
  EXPECT_LE(major, 61);
}

}  // namespace
}  // namespace afterglow
