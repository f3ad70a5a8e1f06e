// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include "images.h"
#include "reference/outline.h"

namespace afterglow::reference {
namespace {

constexpr Size kSize{8, 6};

/// Depth 1 left of column `edge`, 2 from it on.
DoubleImage step(int edge) {
  return generate(kSize, [&](int x, int) { return Rgba(x < edge ? 1 : 2, 0, 0, 1); });
}

OutlineSettings depth_only() { return {.source = OutlineSource::depth, .fade_distance = 1e9}; }

TEST(Outline, OffsetLineSitsOnTheLeftPixelOfAnEdge) {
  const auto depth = step(3);
  const auto mask = outline_mask(kSize, &depth, nullptr, depth_only());
  for (int x = 0; x < kSize.width; ++x) EXPECT_EQ(mask.at(x, 2).r, x == 2 ? 1 : 0) << x;
}

TEST(Outline, WidthIsRoundedAndFadesWithDistance) {
  const auto depth = step(4);
  auto settings = depth_only();
  settings.width = 2.4;
  EXPECT_EQ(outline_mask(kSize, &depth, nullptr, settings).at(2, 0).r, 1) << "rounded to 2 pixels";
  EXPECT_EQ(outline_mask(kSize, &depth, nullptr, settings).at(1, 0).r, 0);
  settings.width = 1;
  settings.fade_distance = 1.9;  // at depth 1 the width falls to 0.47, which rounds to 0
  EXPECT_EQ(outline_mask(kSize, &depth, nullptr, settings).at(3, 0).r, 0);
}

TEST(Outline, DerivativeSharesOneValueInAQuadAndMissesEdgesBetweenQuads) {
  auto settings = depth_only();
  settings.difference = OutlineDifference::derivative;
  const auto inside = step(3), between = step(4);
  const auto mask = outline_mask(kSize, &inside, nullptr, settings);
  for (int x = 0; x < kSize.width; ++x)
    for (int y = 0; y < kSize.height; ++y) EXPECT_EQ(mask.at(x, y).r, x / 2 == 1 ? 1 : 0);
  for (const auto& p : outline_mask(kSize, &between, nullptr, settings).pixels) EXPECT_EQ(p.r, 0);
}

TEST(Outline, TheFourthPixelOfAQuadNeverCounts) {
  auto settings = depth_only();
  settings.difference = OutlineDifference::derivative;
  DoubleImage depth(kSize, Rgba(1));
  depth.at(3, 3) = Rgba(9);
  for (const auto& p : outline_mask(kSize, &depth, nullptr, settings).pixels) EXPECT_EQ(p.r, 0);
}

TEST(Outline, BorderIsClampedSoThereIsNoRim) {
  const DoubleImage depth(kSize, Rgba(5));
  for (const auto& p : outline_mask(kSize, &depth, nullptr, depth_only()).pixels) EXPECT_EQ(p.r, 0);
}

TEST(Outline, NormalsAndCombination) {
  const DoubleImage depth = step(3);
  const auto normal = generate(kSize, [](int x, int) { return x < 3 ? Rgba(1, 0, 0, 1) : Rgba(0, 1, 0, 1); });
  OutlineSettings s{.source = OutlineSource::mixed,
                    .normal_factor = 0.25,
                    .fade_distance = 1e9,
                    .depth_scale = 0.4,
                    .divide_factor = 2};
  const double en = std::sqrt(2.0), ez = 0.4;
  EXPECT_NEAR(outline_mask(kSize, &depth, &normal, s).at(2, 0).r, (0.25 * en + 0.75 * ez) / 2, 1e-12);
  s.combine = OutlineCombine::max;
  EXPECT_NEAR(outline_mask(kSize, &depth, &normal, s).at(2, 0).r, en / 2, 1e-12);
  s.depth_scale = 1.9;
  EXPECT_NEAR(outline_mask(kSize, &depth, &normal, s).at(2, 0).r, 1.9 / 2, 1e-12);
  s.source = OutlineSource::normals;
  s.normal_scale = 0.5;
  EXPECT_NEAR(outline_mask(kSize, nullptr, &normal, s).at(2, 0).r, en / 4, 1e-12) << "no depth: no fade";
}

TEST(Outline, ContrastAroundOneHalf) {
  auto depth = step(3);
  for (auto& p : depth.pixels) p.r *= 0.3;
  auto settings = depth_only();
  EXPECT_NEAR(outline_mask(kSize, &depth, nullptr, settings).at(2, 0).r, 0.3, 1e-12) << "contrast 1 leaves e";
  settings.contrast = 2.5;  // ½(1 − 1/K) = 0.3
  EXPECT_NEAR(outline_mask(kSize, &depth, nullptr, settings).at(2, 0).r, 0, 1e-12);
}

TEST(Outline, DeviceDepth) {
  OutlineSettings s;
  EXPECT_NEAR(linear_eye_depth(1, s), 0.3, 1e-12);
  EXPECT_NEAR(linear_eye_depth(0, s), 1000, 1e-9);
  s.reversed_z = false;
  EXPECT_NEAR(linear_eye_depth(0, s), 0.3, 1e-12);
  EXPECT_NEAR(linear_eye_depth(1, s), 1000, 1e-9);

  const auto depth = generate(kSize, [](int x, int) { return Rgba(x < 3 ? 0.5 : 0.25, 0, 0, 1); });
  s = {.source = OutlineSource::device_depth, .device_depth_input = true};
  EXPECT_NEAR(outline_mask(kSize, &depth, nullptr, s).at(2, 0).r, 0.25, 1e-12) << "raw differences";
  s.source = OutlineSource::depth;
  s.divide_factor = 4;
  const double expected = (linear_eye_depth(0.25, s) - linear_eye_depth(0.5, s)) / 4;
  EXPECT_NEAR(outline_mask(kSize, &depth, nullptr, s).at(2, 0).r, expected, 1e-12) << "linear differences";
}

TEST(Outline, BlendsAndKeepsAlpha) {
  const auto depth = generate(kSize, [](int x, int) { return Rgba(x < 3 ? 1 : 1.25, 0, 0, 1); });
  const DoubleImage source(kSize, Rgba(2, 4, 8, 0.5));
  auto s = depth_only();
  s.color = {1, 0, 0};
  EXPECT_EQ(outline(source, &depth, nullptr, s).at(2, 0), Rgba(1.625, 3, 6, 0.5));
  s.blend = OutlineBlend::add;
  EXPECT_EQ(outline(source, &depth, nullptr, s).at(2, 0), Rgba(2.125, 4, 8, 0.5));
  EXPECT_EQ(outline(source, &depth, nullptr, s).at(5, 0), source.at(5, 0));
}

}  // namespace
}  // namespace afterglow::reference
