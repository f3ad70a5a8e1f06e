// SPDX-License-Identifier: MIT
// How much a bloom flickers from frame to frame, with fireflies and without. AFTERGLOW_FLICKER=shot.####.exr measures a
// sequence instead of the synthetic one and prints the table of docs/benchmarks/flicker.md;
// AFTERGLOW_FLICKER_SETTINGS="search = 1" does so for other settings of firefly_stabilisation.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <random>

#include "image/reader.h"
#include "image/sequence.h"
#include "temporal_player.h"

namespace afterglow {
namespace {

using Frame = std::vector<float>;  ///< RGBA
struct Shot {
  Size size;
  std::vector<Frame> frames;
};

/// A room that does not change under noise that is new in each frame, and some fireflies.
Shot synthetic() {
  Shot shot{{96, 64}, {}};
  for (int n = 1; n <= 12; ++n) {
    std::mt19937 random(static_cast<unsigned>(n));
    std::uniform_real_distribution<float> noise(0.9f, 1.1f);
    Frame frame(static_cast<std::size_t>(shot.size.area()) * 4, 1);
    for (int y = 0; y < shot.size.height; ++y)
      for (int x = 0; x < shot.size.width; ++x) {
        const bool lamp = std::hypot(x - 30, y - 20)<5, window = x> 60 && x < 80 && y > 30 && y < 50;
        for (std::size_t c = 0; c < 3; ++c)
          frame[static_cast<std::size_t>(y * shot.size.width + x) * 4 + c] = (lamp     ? 3.5f
                                                                              : window ? 2.f
                                                                                       : 0.1f) *
                                                                             noise(random);
      }
    for (int i = 0; i < 4 + n % 3; ++i) {
      const std::size_t at = random() % static_cast<std::size_t>(shot.size.area()) * 4;
      for (std::size_t c = 0; c < 3; ++c) frame[at + c] = 200.f * std::pow(2.f, static_cast<float>(random() % 4));
    }
    shot.frames.push_back(std::move(frame));
  }
  return shot;
}

Shot read_shot(const std::string& pattern) {
  Shot shot;
  Diagnostics diagnostics;
  const auto parsed = parse_pattern(pattern);
  EXPECT_TRUE(parsed) << pattern;
  const auto files = find_frames(*parsed, {});
  EXPECT_TRUE(files) << pattern;
  for (const auto& file : *files) {
    auto picture = read_picture(file.file, {}, diagnostics);
    EXPECT_TRUE(picture) << picture.error().text();
    shot.size = picture->color.size();
    shot.frames.push_back(std::move(picture->color.pixels));
  }
  return shot;
}

Shot played(const Shot& shot, const std::string& entries) {
  TemporalPlayer player(entries);
  Shot out{shot.size, {}};
  for (std::size_t i = 0; i < shot.frames.size(); ++i)
    out.frames.push_back(player.play(shot.frames[i], shot.size, static_cast<int>(i) + 1));
  return out;
}

double luminance(const Frame& frame, std::size_t pixel) {
  return 0.2126729 * frame[pixel * 4] + 0.7151522 * frame[pixel * 4 + 1] + 0.0721750 * frame[pixel * 4 + 2];
}

/// The brightest of the 3×3 around a pixel.
double brightest_around(const Frame& frame, Size size, int x, int y) {
  double most = 0;
  for (int v = std::max(y - 1, 0); v <= std::min(y + 1, size.height - 1); ++v)
    for (int u = std::max(x - 1, 0); u <= std::min(x + 1, size.width - 1); ++u)
      most = std::max(most, luminance(frame, static_cast<std::size_t>(v * size.width + u)));
  return most;
}

/// Pixels above 4 that are more than 20 times as bright as the median of the 5×5 around them, and more than twice as
/// bright as anything there in the frame before and in the one after.
int fireflies(const Shot& shot, std::size_t n) {
  const Frame& frame = shot.frames[n];
  const Size size = shot.size;
  int count = 0;
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const double here = luminance(frame, static_cast<std::size_t>(y * size.width + x));
      if (here <= 4 || here <= 2 * brightest_around(shot.frames[n - 1], size, x, y) ||
          here <= 2 * brightest_around(shot.frames[n + 1], size, x, y))
        continue;
      std::vector<double> around;
      for (int v = std::max(y - 2, 0); v <= std::min(y + 2, size.height - 1); ++v)
        for (int u = std::max(x - 2, 0); u <= std::min(x + 2, size.width - 1); ++u)
          around.push_back(luminance(frame, static_cast<std::size_t>(v * size.width + u)));
      std::nth_element(around.begin(), around.begin() + static_cast<std::ptrdiff_t>(around.size() / 2), around.end());
      count += here > 20 * around[around.size() / 2];
    }
  return count;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : values[values.size() / 2];
}

/// How far a frame's value is from the mean of its neighbours', as a share of the mean: the median over the frames, so
/// that lights which are switched do not count.
double flicker(const std::vector<double>& values) {
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  std::vector<double> jumps;
  for (std::size_t i = 1; i + 1 < values.size(); ++i)
    jumps.push_back(std::abs(values[i] - (values[i - 1] + values[i + 1]) / 2) / mean);
  return median(jumps);
}

struct Measured {
  double fireflies = 0;  ///< a frame, median
  double mean = 0;       ///< flicker of the bloom's mean
  double pixels = 0;     ///< flicker of the bloom's pixels: mean over them, as a share of the bloom's mean
};

/// `first` runs before the bloom and belongs to the picture.
Measured measure(const Shot& shot, const std::string& first, const std::string& bloom) {
  const Shot before = first.empty() ? shot : played(shot, first), after = played(shot, first + bloom);
  std::vector<Frame> glow;
  std::vector<double> means, counts, jumps;
  const auto pixels = static_cast<std::size_t>(shot.size.area());
  // The first two frames are those that effects with a history begin with.
  for (std::size_t n = 2; n < shot.frames.size(); ++n) {
    Frame difference(pixels);
    double sum = 0;
    for (std::size_t i = 0; i < pixels; ++i) {
      difference[i] = static_cast<float>(luminance(after.frames[n], i) - luminance(before.frames[n], i));
      sum += difference[i];
    }
    means.push_back(sum / static_cast<double>(pixels));
    glow.push_back(std::move(difference));
    if (n + 1 < shot.frames.size()) counts.push_back(fireflies(before, n));
  }
  for (std::size_t n = 1; n + 1 < glow.size(); ++n) {
    double sum = 0;
    for (std::size_t i = 0; i < pixels; ++i) sum += std::abs(glow[n][i] - (glow[n - 1][i] + glow[n + 1][i]) / 2);
    jumps.push_back(sum / static_cast<double>(pixels) / means[n]);
  }
  return {median(counts), flicker(means), median(jumps)};
}

const std::string kBloom = "fx.bloom { intensity = 0.5 }",
                  kFading = "fx.bloom { intensity = 0.5, fade_fireflies = true }",
                  kStable = "fx.firefly_stabilisation {}, ";

TEST_F(Effects, FirefliesMakeABloomFlickerUntilTheyAreTakenDown) {
  const Shot shot = synthetic();
  const Measured plain = measure(shot, "", kBloom), fading = measure(shot, "", kFading),
                 stable = measure(shot, kStable, kBloom);
  EXPECT_GE(plain.fireflies, 3) << "the test has something to measure";
  EXPECT_GT(plain.mean, 0.1);
  EXPECT_LT(fading.mean, plain.mean / 2);
  EXPECT_LT(stable.mean, plain.mean / 20);
  EXPECT_LT(stable.pixels, plain.pixels / 10);
  EXPECT_EQ(stable.fireflies, 0);
}

TEST_F(Effects, FlickerOfASequence) {
  // AFTERGLOW_FLICKER=shot.####.exr measures another one.
  const char* pattern = std::getenv("AFTERGLOW_FLICKER");
  const Shot shot = read_shot(pattern ? pattern : AFTERGLOW_PROJECT_FOLDER "/tests/images/blender/fireflies.####.exr");
  fmt::print("| | fireflies a frame | flicker of the bloom's mean | of its pixels |\n|---|---|---|---|\n");
  const char* settings = std::getenv("AFTERGLOW_FLICKER_SETTINGS");
  const std::string stabilised = fmt::format("fx.firefly_stabilisation {{ {} }}, ", settings ? settings : "");
  const auto line = [&](const char* name, const std::string& first, const std::string& bloom) {
    const Measured m = measure(shot, first, bloom);
    fmt::print("| {} | {:.0f} | {:.2f} % | {:.2f} % |\n", name, m.fireflies, 100 * m.mean, 100 * m.pixels);
    return m;
  };
  const Measured plain = line("bloom", "", kBloom);
  line("bloom, `fade_fireflies`", "", kFading);
  const Measured stable = line("`firefly_stabilisation`, bloom", stabilised, kBloom);
  line("`firefly_stabilisation`, bloom, `fade_fireflies`", stabilised, kFading);
  EXPECT_LT(stable.fireflies, plain.fireflies);
  EXPECT_LT(stable.pixels, plain.pixels);
}

}  // namespace
}  // namespace afterglow
