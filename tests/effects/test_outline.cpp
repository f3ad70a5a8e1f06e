// SPDX-License-Identifier: MIT
// Outline: the mask and the blend, in every mode.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness.h"
#include "reference/outline.h"

namespace afterglow {
namespace {

using namespace reference;

std::string lua(const OutlineSettings& s) {
  static constexpr const char* kSources[] = {"depth", "device_depth", "normals", "mixed"};
  return fmt::format(
      "fx.outline {{ source = \"{}\", difference = \"{}\", depth_space = \"{}\", near = {}, far = {}, reversed_z = {}, "
      "combine = \"{}\", "
      "normal_factor = {}, width = {}, fade_distance = {}, depth_scale = {}, normal_scale = {}, divide_factor = {}, "
      "contrast = {}, smoothness = {}, level_slopes = {}, "
      "color = {{ {}, {}, {} }}, blend = \"{}\" }}",
      kSources[static_cast<int>(s.source)], s.difference == OutlineDifference::offset ? "offset" : "derivative",
      s.device_depth_input ? "device" : "linear", s.near, s.far, s.reversed_z,
      s.combine == OutlineCombine::weighted ? "weighted" : "max", s.normal_factor, s.width, s.fade_distance,
      s.depth_scale, s.normal_scale, s.divide_factor, s.contrast, s.smoothness, s.level_slopes, s.color.r, s.color.g,
      s.color.b, s.blend == OutlineBlend::lerp ? "lerp" : "add");
}

const DoubleImage* pointer(const std::optional<DoubleImage>& image) { return image ? &*image : nullptr; }

void check(const Scene& scene, const OutlineSettings& s) {
  SCOPED_TRACE(scene.name + ": " + lua(s));
  const Made made = run_stack(lua(s), scene, Way::plain);
  ASSERT_TRUE(made.ran());
  EXPECT_TRUE(agrees(made.pixels("outline.lines"),
                     outline_mask(made.size, pointer(scene.depth), pointer(scene.normal), s), kFullFloat, 1));
  // The mask's rounding counts times the difference of the two colours, here up to ten times as bright as the ink.
  EXPECT_TRUE(agrees(made.result, outline(scene.source, pointer(scene.depth), pointer(scene.normal), s),
                     (2 + 6 * s.smoothness) * kFullFloat, kRgba));
  EXPECT_TRUE(alpha_is_kept(made, scene));
  const Made fused = run_stack(lua(s), scene, Way::fused);
  EXPECT_TRUE(agrees(fused.result, from_floats(made.result.data(), made.size, 4), kFused, kRgba)) << "fused";
}

/// Depth as a depth buffer holds it.
Scene with_device_depth(Scene scene, const OutlineSettings& s) {
  for (auto& p : scene.depth->pixels) {
    const double z = glm::clamp(p.r, s.near, s.far), n = 1 / s.near, f = 1 / s.far;
    const double d = (1 / z - f) / (n - f);
    p.r = s.reversed_z ? d : 1 - d;
  }
  scene.depth = in_floats(*scene.depth);
  return scene;
}

TEST_F(Effects, OutlineAgreesAtEverySizeAndSource) {
  int turn = 0;
  for (const Size size : kSizes)
    for (const auto source : {OutlineSource::depth, OutlineSource::normals, OutlineSource::mixed})
      for (const auto difference : {OutlineDifference::offset, OutlineDifference::derivative}) {
        ++turn;
        check(random_scene(size, 31), {.source = source,
                                       .difference = difference,
                                       .combine = turn % 2 ? OutlineCombine::max : OutlineCombine::weighted,
                                       .normal_factor = 0.3,
                                       .width = 1.0 + turn % 3,
                                       .fade_distance = turn % 4 ? 1e12 : 200.0,
                                       .depth_scale = 0.2,
                                       .normal_scale = 0.7,
                                       .divide_factor = 1.5,
                                       .level_slopes = turn % 5 != 0,
                                       .contrast = 1 + 0.5 * (turn % 5),
                                       .smoothness = 0.5 * (turn % 3),
                                       .color = {0.1, 0.02, 0.3},
                                       .blend = turn % 3 ? OutlineBlend::lerp : OutlineBlend::add});
      }
}

TEST_F(Effects, OutlineOfARealFrameAgrees) {
  const auto scene = neon_scene({320, 180}, 640, 400);
  check(scene, {.combine = OutlineCombine::max,
                .width = 1.6,
                .fade_distance = 40,
                .depth_scale = 4,
                .normal_scale = 0.8,
                .contrast = 4,
                .smoothness = 1});
  check(scene, {});
  check(scene, {.source = OutlineSource::depth, .difference = OutlineDifference::derivative, .depth_scale = 10});
}

TEST_F(Effects, PlanesDrawNoLineHoweverSteep) {
  // Ground to the horizon, and a box that stands on it.
  Scene scene{"ground", DoubleImage(96, 64, Rgba(1, 1, 1, 1)), DoubleImage(96, 64),
              DoubleImage(96, 64, Rgba(0, 0, 1, 1))};
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 96; ++x) {
      const bool box = x >= 40 && x < 60 && y >= 10 && y < 50;
      scene.depth->at(x, y) = Rgba(box ? 6 : 200 / (y + 0.5 + 0.1 * x), 0, 0, 1);
    }
  scene.depth = in_floats(*scene.depth);
  const auto lines = [&](const char* more, int width, int x, int y) {
    const Made made = run_stack(
        fmt::format("fx.outline {{ combine = \"max\", depth_scale = 20, contrast = 5, width = {}{} }}", width, more),
        scene, Way::plain);
    return made.pixels("outline.lines")[4 * static_cast<std::size_t>(96 * y + x)];
  };
  for (const int width : {1, 3}) {
    for (const auto& [x, y] : {std::pair{0, 0}, {20, 1}, {70, 4}, {0, 30}, {80, 12}}) {
      EXPECT_EQ(lines("", width, x, y), 0) << x << " " << y;
    }
    EXPECT_EQ(lines("", width, 39, 12), 1);
    EXPECT_EQ(lines("", width, 59, 12), 1);
    EXPECT_EQ(lines(", level_slopes = false", width, 20, 1), 1);
  }
}

TEST_F(Effects, SmoothLinesHaveNoTeeth) {
  // An edge that each row sees a pixel further left or right, as renderers draw those that lie across pixels.
  Scene scene{"wall", DoubleImage(48, 48, Rgba(1, 1, 1, 1)), DoubleImage(48, 48, Rgba(5, 0, 0, 1)), {}};
  for (int y = 0; y < 48; ++y)
    for (int x = 24 + y % 2; x < 48; ++x) scene.depth->at(x, y).r = 8;
  const auto most_along = [&](const char* more) {
    const auto made =
        run_stack(fmt::format("fx.outline {{ source = \"depth\", contrast = 5{} }}", more), scene, Way::plain).result;
    double most = 0;
    for (int y = 16; y < 32; ++y)
      for (int x = 16; x < 32; ++x) {
        const auto at = 4 * static_cast<std::size_t>(48 * y + x);
        most = std::max<double>(most, std::abs(made[at] - made[at - 4 * 48]));
      }
    return most;
  };
  EXPECT_EQ(most_along(""), 1);
  EXPECT_LT(most_along(", smoothness = 1"), 0.1);
}

TEST_F(Effects, OutlineFromDeviceDepthAgrees) {
  for (const bool reversed : {true, false}) {
    // Blocks without their gradients: a depth buffer's last bits are far apart in metres, and are not what is tested
    // here.
    OutlineSettings s{.source = OutlineSource::depth,
                      .device_depth_input = true,
                      .near = 0.1,
                      .far = 2000,
                      .reversed_z = reversed,
                      .width = 2,
                      .fade_distance = 500,
                      .depth_scale = 0.05};
    const auto scene = with_device_depth(random_scene({101, 57}, 32), s);
    check(scene, s);
    s.source = OutlineSource::device_depth;
    s.depth_scale = 3;
    check(scene, s);
    s.source = OutlineSource::normals;  // device depth serves the fade alone
    check(scene, s);
  }
}

TEST_F(Effects, OutlineOfNormalsWithoutDepthDoesNotFade) {
  auto scene = random_scene({32, 20}, 33);
  scene.depth.reset();
  check(scene, {.source = OutlineSource::normals, .width = 2, .fade_distance = 0.001});
}

TEST_F(Effects, OutlineIsSkippedWithoutItsInputs) {
  auto scene = random_scene({32, 20}, 34);
  scene.normal.reset();
  const Made made = run_stack("fx.outline {}", scene, Way::plain);
  EXPECT_FALSE(made.ran());
  ASSERT_EQ(made.graph.skipped.size(), 1u);
  EXPECT_THAT(made.graph.skipped[0].reason, testing::HasSubstr("normal"));
  EXPECT_THAT(build_error("fx.outline { required = true }", scene), testing::HasSubstr("normal"));
  EXPECT_TRUE(run_stack("fx.outline { source = \"depth\" }", scene, Way::plain).ran());
}

TEST_F(Effects, OutlineThatDrawsNothingDoesNotRun) {
  const auto scene = random_scene({32, 20}, 35);
  EXPECT_EQ(run_stack("fx.outline { width = 0.4 }", scene, Way::plain).graph.skipped.at(0).reason,
            "width rounds to 0 pixels");
  EXPECT_EQ(run_stack("fx.outline { blend = \"add\" }", scene, Way::plain).graph.skipped.at(0).reason, "adds black");
}

TEST_F(Effects, DeviceDepthSourceRequiresDeviceDepthSpace) {
  EXPECT_THAT(build_error("fx.outline { source = \"device_depth\" }", random_scene({8, 8}, 36)),
              testing::HasSubstr("source = \"device_depth\" requires depth_space = \"device\""));
}

}  // namespace
}  // namespace afterglow
