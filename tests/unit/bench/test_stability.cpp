// SPDX-License-Identifier: MIT
// The scenes of `bench --temporal`, and what it measures, against what is known of simple looks.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "bench/report.h"
#include "bench/stability.h"

namespace afterglow::bench {
namespace {

double sum_of(const Picture& picture) {
  double sum = 0;
  for (std::size_t i = 0; i < picture.color.pixels.size(); i += 4) sum += picture.color.pixels[i] - 0.05;
  return sum;
}

TEST(Stability, AHighlightHasTheSameLightWhereverItIs) {
  for (const double radius : {0.25, 0.5, 1.0, 3.0}) {
    const auto frames = drifting_highlight({64, 36}, radius, 20);
    ASSERT_EQ(frames.size(), 20u);
    const double expected = 3.14159265 * radius * radius * (60 - 0.05);
    for (const auto& frame : frames) EXPECT_NEAR(sum_of(frame) / expected, 1, radius < 0.5 ? 0.02 : 0.01) << radius;
    EXPECT_NE(frames[3].color.pixels, frames[4].color.pixels);
  }
}

TEST(Stability, LampsAreTheSameSceneAtEverySize) {
  const double small = sum_of(lamps({160, 90})) / (160 * 90), large = sum_of(lamps({640, 360})) / (640 * 360);
  EXPECT_NEAR(small / large, 1, 0.01);
}

class StabilityOnADevice : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("afterglow_stability_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "look.lua") << "local fx = require \"afterglow\"\n"
                                           "return fx.stack { fx.bloom { intensity = 0.5 } }\n";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  static Result<void> nothing(const std::string&) { return {}; }
  TemporalCurve shot(const std::vector<Override>& overrides, double radius) {
    Variant variant;
    variant.overrides = overrides;
    auto curve = measure_shot(
        {.preset = folder_ / "look.lua", .options = {}, .variant = variant, .scene = "x", .radius = radius},
        drifting_highlight({256, 128}, radius, 18), diagnostics_, nothing);
    EXPECT_TRUE(curve) << curve.error().text();
    return *curve;
  }
  std::filesystem::path folder_;
  Diagnostics diagnostics_;
};

TEST_F(StabilityOnADevice, LargeHighlightsAreSteadierThanSmallOnes) {
  const TemporalCurve small = shot({}, 0.5), large = shot({}, 4);
  EXPECT_EQ(small.light.size(), 16u);
  EXPECT_GT(small.swing, 2 * large.swing);
  EXPECT_GT(small.pixels, large.pixels);
  EXPECT_LT(large.swing, 0.1);
  double mean = 0;
  for (const double light : small.light) mean += light / 16;
  EXPECT_NEAR(mean, 1, 1e-9);
}

TEST_F(StabilityOnADevice, ResolutionsDifferUntilTheyHaveAReference) {
  const std::vector<Size> sizes{{160, 90}, {320, 180}};
  const auto plain = measure_resolutions(folder_ / "look.lua", {}, {}, sizes, diagnostics_, nothing);
  Variant fixed;
  fixed.overrides = {*parse_override("bloom.reference_height=90")};
  const auto same = measure_resolutions(folder_ / "look.lua", {}, fixed, sizes, diagnostics_, nothing);
  ASSERT_TRUE(plain && same);
  EXPECT_EQ(plain->at(0).worst, 0);
  EXPECT_GT(plain->at(1).worst, 0.2);
  EXPECT_LT(same->at(1).worst, 0.02);
  const auto wrong = measure_resolutions(folder_ / "look.lua", {}, {}, {{160, 90}, {100, 100}}, diagnostics_, nothing);
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().kind, ErrorKind::usage);
}

TEST(Stability, ReportsHoldTheCurves) {
  Report report;
  report.temporal.push_back(
      {.preset = "a", .settings = "b=1", .scene = "s", .size = {4, 2}, .radius = 0.5, .light = {0.5, 1.5}, .swing = 1});
  report.temporal.push_back(
      {.preset = "a", .settings = "b=1", .scene = "t", .size = {4, 2}, .radius = 2, .light = {1}, .swing = 0.25});
  report.resolutions.push_back({.preset = "a", .settings = "", .size = {8, 4}, .worst = 0.125, .rms = 0.0625});
  const auto json = nlohmann::json::parse(report_json(report));
  EXPECT_EQ(json["temporal"][0]["light"][1], 1.5);
  EXPECT_EQ(json["resolutions"][0]["worst"], 0.125);
  EXPECT_NE(stability_csv(report).find("shot,\"a\",\"b=1\",\"t\",4,2,2,0.25"), std::string::npos);
  EXPECT_NE(stability_csv(report).find("resolution,\"a\",\"\",lamps,8,4,,,,,0.125,0.0625"), std::string::npos);
  EXPECT_NE(temporal_svg(report).find("a b=1"), std::string::npos);
  EXPECT_NE(report_html(report).find("id=\"swing\""), std::string::npos);
}

}  // namespace
}  // namespace afterglow::bench
