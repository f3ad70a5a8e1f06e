// SPDX-License-Identifier: MIT
// Film grain: the oracle to the bit of its noise, and what makes it grain.
#include <fmt/format.h>

#include <cmath>

#include "cases.h"
#include "reference/grain.h"

namespace afterglow {
namespace {

using namespace reference;

EffectCase grained(const FilmGrain& v) {
  return {fmt::format("fx.film_grain {{ intensity = {}, response = {}, size = {}, colored = {}, seed = {} }}",
                      v.intensity, v.response, v.size, v.colored, v.seed),
          [=](const Scene& s) {
            auto settings = v;
            settings.frame = static_cast<std::uint32_t>(s.frame);
            return film_grain(s.source, settings);
          }};
}

/// A picture of one grey, frame by frame.
std::vector<float> grain_of(double frame, const char* entries = "fx.film_grain { intensity = 1, response = 0 }") {
  return run_stack(entries, {"grey", DoubleImage(128, 128, Rgba(0.25, 0.25, 0.25, 1)), {}, {}, frame}, Way::plain)
      .result;
}

TEST_F(Effects, FilmGrainAgrees) {
  agree_everywhere({grained({}), grained({.intensity = 1, .response = 0, .colored = 1, .seed = 7}),
                    grained({.intensity = 0.7, .response = 1, .size = 2.3, .colored = 0.4}),
                    grained({.size = 1.5, .seed = 2147483647}),
                    grained({.intensity = 1, .response = 0, .size = 1.2, .colored = 1})});
  expect_skipped("fx.film_grain { intensity = 0 }", "intensity is 0");
}

TEST_F(Effects, FilmGrainDependsOnTheFrameAlone) {
  const auto first = grain_of(1), second = grain_of(2);
  EXPECT_NE(first, second);
  EXPECT_EQ(first, grain_of(1));
  EXPECT_NE(first, grain_of(1, "fx.film_grain { intensity = 1, response = 0, seed = 1 }"));
}

TEST_F(Effects, FilmGrainHasMeanOneAndItsDeviationAtEverySize) {
  for (const char* entries :
       {"fx.film_grain { intensity = 1, response = 0 }", "fx.film_grain { intensity = 1, response = 0, size = 1.25 }",
        "fx.film_grain { intensity = 1, response = 0, size = 1.7 }"}) {
    double sum = 0, squares = 0;
    constexpr int kFrames = 8;
    for (int frame = 1; frame <= kFrames; ++frame) {
      const auto pixels = grain_of(frame, entries);
      for (std::size_t i = 0; i < pixels.size(); i += 4) {
        const double noise = pixels[i] / 0.25 - 1;
        sum += noise;
        squares += noise * noise;
      }
    }
    constexpr double kCount = 128.0 * 128 * kFrames;
    EXPECT_NEAR(sum / kCount, 0, 0.005) << entries;
    EXPECT_NEAR(std::sqrt(squares / kCount), 0.25, 0.005) << entries;
  }
}

std::uint32_t word_of(std::uint32_t x) {  // shaders/lib/noise.glsl
  x = (x ^ (x >> 16u)) * 0x7feb352du;
  x = (x ^ (x >> 15u)) * 0x846ca68bu;
  return x ^ (x >> 16u);
}

/// Where a cell has the number of the pixel that it lies on, the grain of both is no stronger than elsewhere.
TEST_F(Effects, FilmGrainOfPixelsAndOfCellsKnowNothingOfEachOther) {
  constexpr int kFrames = 150, kSide = 128;
  double squares = 0;
  int count = 0;
  for (int frame = 1; frame <= kFrames; ++frame) {
    const auto pixels = grain_of(frame, "fx.film_grain { intensity = 1, response = 0, size = 1.4 }");
    const std::uint32_t key = word_of(word_of(0) + static_cast<std::uint32_t>(frame));
    const double side = 1.4 * std::sqrt(2.0 / 3);
    const int x = static_cast<int>((key >> 24u) / 16.0 / (side - 1)),
              y = static_cast<int>((key >> 16u & 255u) / 16.0 / (side - 1));
    for (int j = std::max(y, 1) - 1; j <= std::min(y + 1, kSide - 1); ++j)
      for (int i = std::max(x, 1) - 1; i <= std::min(x + 1, kSide - 1); ++i, ++count) {
        const double noise = (pixels[4 * static_cast<std::size_t>(kSide * j + i)] / 0.25 - 1) / 0.25;
        squares += noise * noise;
      }
  }
  ASSERT_GT(count, 1000);
  EXPECT_NEAR(std::sqrt(squares / count), 1, 0.1);
}

/// Mean difference of neighbours across, by column, over many frames.
std::vector<double> sharpness_by_column(const char* entries, int frames) {
  std::vector<double> sharpness(128);
  for (int frame = 1; frame <= frames; ++frame) {
    const auto pixels = grain_of(frame, entries);
    for (std::size_t i = 0; i + 4 < pixels.size(); i += 4)
      if (i / 4 % 128 != 127) sharpness[i / 4 % 128] += std::abs(pixels[i + 4] - pixels[i]);
  }
  sharpness.pop_back();
  return sharpness;
}

TEST_F(Effects, FilmGrainHasNoLatticeThatStandsStill) {
  for (const char* entries : {"fx.film_grain { intensity = 1, response = 0, size = 1.4 }",
                              "fx.film_grain { intensity = 1, response = 0, size = 4 }"}) {
    const auto sharpness = sharpness_by_column(entries, 48);
    double mean = 0, squares = 0;
    for (const double v : sharpness) mean += v / 127, squares += v * v / 127;
    EXPECT_LT(std::sqrt(squares - mean * mean), 0.05 * mean) << entries;
  }
}

TEST_F(Effects, ColouredGrainIsAlikeInAllChannels) {
  const Scene scene{"grey", DoubleImage(256, 256, Rgba(0.25, 0.25, 0.25, 1)), {}, {}};
  for (const double colored : {0.0, 0.3, 0.5, 1.0}) {
    const auto made =
        run_stack(fmt::format("fx.film_grain {{ intensity = 1, colored = {} }}", colored), scene, Way::plain).result;
    double squares[3] = {}, products[3] = {};
    for (std::size_t i = 0; i < made.size(); i += 4)
      for (std::size_t c = 0; c < 3; ++c) {
        const double a = made[i + c] / 0.25 - 1, b = made[i + (c + 1) % 3] / 0.25 - 1;
        squares[c] += a * a, products[c] += a * b;
      }
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(squares[c] / squares[1], 1, 0.03) << colored << " " << c;
      const double shared = products[c] / squares[c], wanted = (1 - colored) * (1 - colored);
      EXPECT_NEAR(shared, wanted / (wanted + colored * colored), 0.03) << colored << " " << c;
    }
  }
}

}  // namespace
}  // namespace afterglow
