// SPDX-License-Identifier: MIT
// Whatever finite light comes in and however extreme the settings are, what comes out is finite.
#include <cmath>
#include <random>

#include "harness.h"

namespace afterglow {
namespace {

using namespace reference;

/// `below`: of three values one is that far below 0, as --gamut keep leaves them.
Scene stress_scene(Size size, bool below = false) {
  static constexpr double kValues[] = {0, 1e30, 65504, 1e4, 1e-38, 1e-10, 0.18, 1, 60, 3e29, 1e20, 65536};
  std::mt19937 generator(51);
  std::uniform_int_distribution<std::size_t> pick(0, std::size(kValues) - 1);
  const auto any = [&] { return kValues[pick(generator)]; };
  const auto light = [&] { return below && generator() % 3 == 0 ? -std::min(any(), 65504.0) : any(); };
  Scene scene{"stress", DoubleImage(size), DoubleImage(size), DoubleImage(size)};
  for (std::size_t i = 0; i < scene.source.pixels.size(); ++i) {
    scene.source.pixels[i] = Rgba(light(), light(), light(), i % 3 * 0.5);
    scene.depth->pixels[i] = Rgba(any(), 0, 0, 1);
    scene.normal->pixels[i] = Rgba(any(), -any(), any(), 1);
  }
  scene.source = in_floats(scene.source);
  return scene;
}

const char* const kExtremes[] = {
    "fx.bloom { threshold = 0, knee = 0, intensity = 1e12 }",
    "fx.bloom { threshold = 3.4e38, knee = 1, intensity = 3.4e38, bicubic_upsampling = false }",
    "fx.bloom { mode = \"scattering\", threshold = 0, knee = 1, intensity = 1, scatter = 0.95, fade_fireflies = true }",
    "fx.bloom { mode = \"scattering\", threshold = 100, knee = 1, downscale_limit = 1, scatter = 0.05, fade_fireflies "
    "= true }",
    "fx.box_bloom { threshold = 0, blur_iterations = 7 }",
    "fx.box_bloom { threshold = 3, blur_iterations = 1, brightness = \"luma\" }",
    "fx.tone_mapping { mode = \"aces\" }",
    "fx.tone_mapping { mode = \"neutral\" }",
    "fx.tone_mapping { mode = \"reinhard\" }",
    "fx.color_blit { intensity = 2 }",
    "fx.color_adjustments { post_exposure = 200 }",
    "fx.color_adjustments { post_exposure = -300, contrast = 100 }",
    "fx.color_adjustments { post_exposure = 100, contrast = 100, color_filter = { 1e30, 1e-30, 0 }, hue_shift = 180, "
    "saturation = 100 }",
    "fx.color_adjustments { contrast = -100, color_filter = { 3.4e38, 1e-300, 1 }, hue_shift = -180, saturation = -100 "
    "}",
    "fx.color_adjustments { contrast = -99.9, hue_shift = 0.001 }",
    "fx.outline {}",
    "fx.outline { depth_scale = 3.4e38, normal_scale = -3.4e38, normal_factor = 0, divide_factor = 1e-6, contrast = "
    "3.4e38, width = 3.4e38 }",
    "fx.outline { difference = \"derivative\", combine = \"max\", contrast = 0, color = { 1e30, 1e30, 1e30 }, blend = "
    "\"add\" }",
    "fx.outline { source = \"depth\", depth_space = \"device\", near = 1e-6, far = 1e30, fade_distance = 1e-6 }",
    "fx.outline { source = \"mixed\", depth_space = \"device\", near = 5, far = 5, reversed_z = false, fade_distance = "
    "1e30 }",
    "fx.white_balance { temperature = 100, tint = -100 }",
    "fx.white_balance { temperature = -100, tint = 100 }",
    "fx.channel_mixer { red_out_green_in = 200, red_out_blue_in = 200, green_out_red_in = -200, blue_out_blue_in = "
    "-200 }",
    "fx.split_toning { shadows = { 0, 1e30, 0.5 }, highlights = { 1e30, 0, 0 }, balance = -100 }",
    "fx.split_toning { shadows = { 0, 0, 0 }, highlights = { 0, 0, 0 }, balance = 100 }",
    "fx.shadows_midtones_highlights { shadows = { 3.4e38, 0, 1 }, midtones_offset = 1, highlights_offset = -1, "
    "shadows_start "
    "= 100, shadows_end = 0, highlights_start = 0, highlights_end = 0 }",
    "fx.shadows_midtones_highlights { highlights = { 3.4e38, 3.4e38, 3.4e38 } }",
    "fx.lift_gamma_gain { lift = { 3.4e38, 0, 0 }, gamma = { 0, 3.4e38, 0 }, gain = { 0, 0, 3.4e38 }, lift_offset = 1 "
    "}",
    "fx.lift_gamma_gain { lift_offset = -1, gamma_offset = -1, gain_offset = -1 }",
    "fx.lift_gamma_gain { gamma_offset = 1, gain_offset = 1 }",
    "fx.vignette { intensity = 1, smoothness = 0.01, color = { 1e30, 0, 1e-30 }, center = { 0, 1 }, rounded = true }",
    "fx.chromatic_aberration { intensity = 1, samples = 24 }",
    "fx.lens_distortion { intensity = 1, scale = 0.01, center = { 1, 1 } }",
    "fx.lens_distortion { intensity = -1, x_multiplier = 0, scale = 5, center = { 0, 0 } }",
    "fx.film_grain { intensity = 1, response = 0, size = 16, colored = 1, seed = 2147483647 }",
    "fx.sharpen { intensity = 1, contrast = 1 }",
    "fx.fxaa { fixed_threshold = 0.0312, relative_threshold = 0.063, subpixel_blending = 1 }",
    "fx.pixelate { size = 1024 }",
    "fx.edge_detection { operator = \"scharr\", intensity = 100, threshold = 0, color = { 1e30, 0, 0 }, "
    "background_opacity = "
    "1 }",
    "fx.dual_kawase { iterations = 12, offset = 3 }",
    "fx.radial_blur { intensity = 1, samples = 128, center = { 1, 0 } }",
    "fx.directional_blur { distance = 1000, angle = 77 }",
    "fx.bokeh_blur { radius = 64, blades = 3, highlights = 50 }",
    "fx.anamorphic_streaks { threshold = 0, stretch = 1, intensity = 100, tint = { 1e30, 1e30, 1e30 } }",
    "fx.lens_dirt { threshold = 0, intensity = 100, density = 1, size = 0.5 }",
    "fx.lens_dirt { size = 0.005, seed = 2147483647 }",
    "fx.glitch { scan_line_jitter = 1, line_height = 1024, horizontal_shake = 1, rgb_split = 1, vertical_roll = 30 }",
    "fx.depth_of_field { aperture = 0.1, focal_length = 1000, max_radius = 64, samples = 16 }",
    "fx.depth_of_field { focus_distance = 1e6, depth_space = \"device\", near = 1e-6, far = 1e30, sensor_height = 1 }",
    "fx.bloom { threshold = 0, intensity = 1e12 }, fx.tone_mapping {}, fx.color_adjustments { post_exposure = 20, "
    "contrast = 90, hue_shift = 77, saturation = 100 }",
};

TEST_F(Effects, NothingTurnsNonFinite) {
  for (const Size size : {Size{37, 23}, Size{4, 4}})
    for (const char* entries : kExtremes) {
      const auto scene = stress_scene(size);
      const Made made = run_stack(entries, scene, Way::plain);
      for (const auto& [name, pixels] : made.images) EXPECT_TRUE(all_finite(pixels)) << entries << " " << name;
      EXPECT_TRUE(all_finite(made.result)) << entries;
      EXPECT_TRUE(alpha_is_kept(made, scene)) << entries;
      EXPECT_TRUE(all_finite(run_stack(entries, scene, Way::fused).result)) << entries;
    }
}

TEST_F(Effects, LightBelowZeroTurnsNothingNonFinite) {
  const Scene scene = stress_scene({37, 23}, true);
  for (const char* entries : kExtremes) {
    const Made made = run_stack(entries, scene, Way::plain);
    for (const auto& [name, pixels] : made.images) EXPECT_TRUE(all_finite(pixels)) << entries << " " << name;
    EXPECT_TRUE(all_finite(run_stack(entries, scene, Way::fused).result)) << entries;
  }
}

TEST_F(Effects, NothingTurnsNonFiniteInHalfFloats) {
  for (const char* entries : kExtremes) {
    const Made made = run_stack(entries, stress_scene({37, 23}), Way::fused_half);
    EXPECT_TRUE(all_finite(made.result)) << entries;
    for (const float v : made.result) ASSERT_LE(std::abs(v), 65504.0F) << entries;
  }
}

TEST_F(Effects, BlackStaysBlack) {
  const Scene scene{"black", DoubleImage(32, 18, Rgba(0, 0, 0, 0)), {}, {}};
  for (const char* entries : {"fx.bloom {}", "fx.bloom { mode = \"scattering\", threshold = 0 }", "fx.box_bloom {}",
                              "fx.tone_mapping {}", "fx.tone_mapping { mode = \"neutral\" }",
                              "fx.color_adjustments { contrast = 50, hue_shift = 20, saturation = 50 }"})
    for (const float v : run_stack(entries, scene, Way::fused).result) ASSERT_EQ(v, 0.0F) << entries;
}

}  // namespace
}  // namespace afterglow
