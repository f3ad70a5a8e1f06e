// SPDX-License-Identifier: MIT
// Frames in which an effect has nothing to do: run without it, bit for bit as with it.
#include <gtest/gtest.h>
#include <unistd.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <random>

#include "session/session.h"

namespace afterglow {
namespace {

class Idle : public testing::Test {
 protected:
  void SetUp() override {
    setenv("AFTERGLOW_HOME", AFTERGLOW_PROJECT_FOLDER, 1);
    setenv("XDG_RUNTIME_DIR", testing::TempDir().c_str(), 0);
  }
  void TearDown() override { std::filesystem::remove(file()); }

  static std::string file() { return testing::TempDir() + "/afterglow_idle_" + std::to_string(getpid()) + ".lua"; }

  void open(const std::string& entries, Precision precision = Precision::automatic) {
    std::ofstream(file()) << "local fx = require \"afterglow\"\nreturn fx.stack {" << entries << "}\n";
    for (const bool skip : {true, false}) {
      SessionOptions options;
      options.device.validate = true;
      options.stack.precision = precision;
      options.stack.skip_idle = skip;
      auto session = Session::open(file(), options, diagnostics_);
      ASSERT_TRUE(session) << session.error().text();
      (skip ? with_ : without_) = std::move(*session);
    }
  }

  /// Runs it both ways; the reasons for what was left out.
  std::vector<Skipped> same_both_ways(const Image& image) {
    Picture a, b;
    a.color = b.color = image;
    EXPECT_TRUE(with_->process(a));
    EXPECT_TRUE(without_->process(b));
    int different = 0;
    for (std::size_t i = 0; i < a.color.pixels.size(); ++i)
      different += std::bit_cast<std::uint32_t>(a.color.pixels[i]) != std::bit_cast<std::uint32_t>(b.color.pixels[i]);
    EXPECT_EQ(different, 0);
    EXPECT_TRUE(without_->report().skipped_now.empty());
    return with_->report().skipped_now;
  }

  static Image noise(Size size, float largest, unsigned seed) {
    Image out(size.width, size.height, 4);
    std::mt19937 random(seed);
    for (auto& value : out.pixels) value = std::min(largest, largest * static_cast<float>(random() % 4097) / 4096.0f);
    for (int y = 0; y < size.height / 2; ++y)  // a part at the very limit, beside blacks
      for (int x = 0; x < size.width; ++x)
        for (int c = 0; c < 3; ++c) out.at(x, y)[c] = (x / 8) % 2 ? largest : 0.0f;
    return out;
  }

  Diagnostics diagnostics_;
  std::unique_ptr<Session> with_, without_;
};

/// Linear limits of bloom, rounded as its shader has them.
float limit_of(double gamma_threshold, double knee) {
  const double t =
      gamma_threshold < 1 ? std::pow((gamma_threshold + 0.055) / 1.055, 2.4) : std::pow(gamma_threshold, 2.2);
  return static_cast<float>(t - t * knee);
}

TEST_F(Idle, BloomUpToTheLimitAndAbove) {
  for (const std::string mode : {"additive", "scattering"})
    for (const double knee : {0.5, 0.0, 0.37})
      for (const double threshold : {1.0, 0.9, 1.3}) {
        const std::string settings = "fx.bloom { mode = \"" + mode + "\", knee = " + std::to_string(knee) +
                                     ", threshold = " + std::to_string(threshold) +
                                     ", fade_fireflies = " + (knee == 0.37 ? "true" : "false") + " }";
        SCOPED_TRACE(settings);
        open(settings + ", fx.tone_mapping { mode = \"reinhard\" }");
        const float limit = limit_of(threshold, knee);
        const auto at = same_both_ways(noise({64, 48}, limit, 1));
        ASSERT_EQ(at.size(), 1u);
        EXPECT_EQ(at[0].name, "bloom");
        EXPECT_EQ(with_->report().kernels, std::vector<std::string>{"tone_mapping.reinhard"});
        EXPECT_TRUE(same_both_ways(noise({64, 48}, std::nextafter(limit, 2.0f), 2)).empty());
        EXPECT_EQ(same_both_ways(noise({64, 48}, limit / 3, 3)).size(), 1u);
      }
}

TEST_F(Idle, LargePicturesWhoseKernelsAreOthers) {
  open("fx.bloom { knee = 0, threshold = 1.3 }, fx.tone_mapping { mode = \"reinhard\" }");
  const float limit = limit_of(1.3, 0);
  EXPECT_EQ(same_both_ways(noise({1024, 512}, limit, 1)).size(), 1u);
  EXPECT_TRUE(same_both_ways(noise({1024, 512}, std::nextafter(limit, 2.0f), 2)).empty());
}

TEST_F(Idle, OddSizesStayBelowTheLimit) {
  open("fx.bloom { knee = 0, mode = \"scattering\" }, fx.tone_mapping { mode = \"reinhard\" }");
  EXPECT_TRUE(same_both_ways(noise({61, 47}, 1.0f, 1)).empty());
  EXPECT_EQ(same_both_ways(noise({61, 47}, 1.0f - 2e-6f, 2)).size(), 1u);
  EXPECT_EQ(same_both_ways(noise({64, 47}, 1.0f - 2e-6f, 3)).size(), 1u);
}

TEST_F(Idle, OneBrightPixelInAnyCornerRunsTheEffect) {
  open("fx.bloom { }, fx.tone_mapping { mode = \"reinhard\" }");
  const Size size{64, 48};
  for (const int x : {0, size.width - 1})
    for (const int y : {0, size.height - 1})
      for (int c = 0; c < 4; ++c) {
        Image image = noise(size, 0.5f, 7);
        image.at(x, y)[c] = 9;
        EXPECT_EQ(same_both_ways(image).size(), c == 3 ? 1u : 0u) << x << "," << y << "," << c;
      }
}

TEST_F(Idle, ValuesThatAreNoLightRunTheEffect) {
  open("fx.bloom { }, fx.tone_mapping { mode = \"reinhard\" }");
  const float inf = std::numeric_limits<float>::infinity();
  for (const float value : {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::quiet_NaN(), inf,
                            -inf, -1.0f, -0.0f, -1e-30f, 3e38f}) {
    Image image = noise({64, 48}, 0.25f, 5);
    image.at(33, 20)[1] = value;
    Picture picture;
    picture.color = image;
    ASSERT_TRUE(with_->process(picture));
    EXPECT_TRUE(with_->report().skipped_now.empty()) << value;
  }
}

TEST_F(Idle, BoxBloom) {
  for (const std::string brightness : {"max", "luma"}) {
    open("fx.box_bloom { threshold = 0.8, brightness = \"" + brightness +
         "\" }, fx.tone_mapping { mode = \"reinhard\" }");
    EXPECT_EQ(same_both_ways(noise({61, 47}, 0.8f, 1)).size(), brightness == "max" ? 1u : 0u);
    EXPECT_EQ(same_both_ways(noise({61, 47}, 0.799998f, 2)).size(), 1u);
    EXPECT_TRUE(same_both_ways(noise({61, 47}, 0.80001f, 3)).empty());
  }
}

TEST_F(Idle, BothBloomsOfAStack) {
  open("fx.bloom { }, fx.box_bloom { }, fx.tone_mapping { mode = \"reinhard\" }");
  EXPECT_EQ(same_both_ways(noise({64, 48}, 0.4f, 1)).size(), 2u);
  EXPECT_TRUE(same_both_ways(noise({64, 48}, 0.7f, 2)).empty());  // bloom runs: what box_bloom gets is not known
}

TEST_F(Idle, NothingLeftLeavesThePicture) {
  open("fx.bloom { mode = \"scattering\" }", Precision::fp32);  // halves would round what is run
  const Image image = noise({64, 48}, 0.5f, 1);
  EXPECT_EQ(same_both_ways(image).size(), 1u);
  EXPECT_TRUE(with_->report().kernels.empty());
}

TEST_F(Idle, HalfStorageLooksAtWhatTheDeviceReads) {
  open("fx.bloom { threshold = 1.3, knee = 0 }, fx.tone_mapping { mode = \"reinhard\" }", Precision::fp16);
  const float limit = limit_of(1.3, 0);
  EXPECT_TRUE(same_both_ways(noise({64, 48}, limit * 1.001f, 1)).empty());
  EXPECT_EQ(same_both_ways(noise({64, 48}, limit * 0.999f, 2)).size(), 1u);
  (void)same_both_ways(noise({64, 48}, limit, 3));
}

TEST_F(Idle, AlternatingFramesMakeNothingNew) {
  open("fx.bloom { }, fx.tone_mapping { mode = \"reinhard\" }");
  const Image dark = noise({64, 48}, 0.4f, 1), bright = noise({64, 48}, 4, 2);
  EXPECT_EQ(same_both_ways(dark).size(), 1u);
  EXPECT_TRUE(same_both_ways(bright).empty());
  const auto before = with_->report().counters;
  EXPECT_EQ(before.programs, 3);  // for opaque pictures, and for these with and without the bloom
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(same_both_ways(dark).size(), 1u);
    EXPECT_TRUE(same_both_ways(bright).empty());
  }
  const auto after = with_->report().counters;
  EXPECT_EQ(after.programs, before.programs);
  EXPECT_EQ(after.images, before.images);
  EXPECT_EQ(after.buffers, before.buffers);
}

TEST_F(Idle, EffectsBehindAChangeAreRun) {
  open("fx.color_blit { intensity = 2 }, fx.bloom { }, fx.tone_mapping { mode = \"reinhard\" }");
  EXPECT_TRUE(same_both_ways(noise({64, 48}, 0.4f, 1)).empty());
}

}  // namespace
}  // namespace afterglow
