// SPDX-License-Identifier: MIT
// Opacity, blend modes, masks, groups and mixes on every entry, against the oracle (math.md §20).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "bench/oracle.h"
#include "cases.h"
#include "files.h"
#include "image/cryptomatte.h"
#include "image/writer.h"
#include "reference/color.h"
#include "reference/composite.h"
#include "reference/tone_mapping.h"

namespace afterglow {
namespace {

using namespace reference;

constexpr const char* kModes[] = {"normal",  "add",    "screen",     "multiply", "overlay",   "soft_light",
                                  "lighten", "darken", "hard_light", "color",    "luminosity"};

/// The stack's own entries, as the bench gives them to the oracle, on the scene.
DoubleImage truth(const std::string& entries, const Scene& scene) {
  const auto file =
      write_test_file("truth.lua", "local fx = require \"afterglow\"\nreturn fx.stack {\n" + entries + "\n}\n");
  Diagnostics diagnostics;
  ShaderLibrary shaders(search_path_for(file, {}));
  auto preset = Preset::load(file, {}, shaders, diagnostics);
  if (!preset) throw std::runtime_error(preset.error().text());
  BuildContext context;
  context.size = scene.source.size();
  Inputs inputs;
  if (scene.depth) context.auxiliary["depth"] = context.size, inputs.depth = &*scene.depth;
  for (const auto& [name, image] : scene.layers) {
    context.auxiliary["layer:" + name] = image.size();
    inputs.layers[name] = &image;
  }
  const auto build = preset->evaluate(context, diagnostics);
  if (!build) throw std::runtime_error(build.error().text());
  const auto all = bench::oracle_entries(*build);
  EXPECT_EQ(effect_without_oracle(all), "");
  return evaluate(scene.source, inputs, all);
}

void expect_true(const std::string& entries, const Scene& scene, double tolerance = kFullFloat) {
  const DoubleImage expected = truth(entries, scene);
  for (const Way way : {Way::plain, Way::fused}) {
    const Made made = run_stack(entries, scene, way);
    EXPECT_TRUE(made.ran()) << entries;
    EXPECT_TRUE(agrees(made.result, expected, tolerance, kRgb))
        << entries << (way == Way::plain ? ", plain" : ", fused");
    EXPECT_TRUE(alpha_is_kept(made, scene)) << entries;
  }
}

/// Light around white on both sides, so that every branch of the modes is met; soft alpha.
Scene light(Size size = {61, 37}) {
  Scene scene = random_scene(size, 5);
  for (auto& p : scene.source.pixels) {
    p.a = 0.25 + 0.75 * p.a;
    p = Rgba(glm::min(Rgb(p), Rgb(8)) * p.a, p.a);
  }
  scene.source = in_floats(scene.source);
  DoubleImage layer(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      layer.at(x, y) = Rgba((x % 9) / 8.0, (y % 5) / 4.0, ((x + y) % 7) / 6.0, (x * y % 11) / 10.0);
  scene.layers["matte"] = in_floats(layer);
  constexpr int kObjects[] = {0, 3, 300, 1, 16777215, 3, 299};
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) layer.at(x, y) = Rgba(kObjects[(x / 5 + y / 3) % 7], 0, 0, 1);
  scene.layers["objects"] = std::move(layer);
  return scene;
}

TEST_F(Effects, BlendModesAgree) {
  const Scene scene = light();
  for (const char* mode : kModes)
    for (const double opacity : {1.0, 0.4})
      for (const char* effect : {"fx.color_adjustments { post_exposure = -0.7, contrast = 20,",
                                 "fx.channel_mixer { red_out_green_in = 60, green_out_red_in = -40,"})
        if (mode != std::string("normal") || opacity < 1)
          expect_true(fmt::format("{} blend = \"{}\", opacity = {} }}", effect, mode, opacity), scene, 2e-5);
}

TEST_F(Effects, BlendModesAreWhatTheirNamesSay) {
  const auto at = [](double b, double s, const char* mode) { return blend(Rgb(b), Rgb(s), mode).r; };
  EXPECT_DOUBLE_EQ(at(0.3, 0.5, "screen"), 0.65);
  EXPECT_DOUBLE_EQ(at(3, 0.5, "screen"), 3);  // beyond white the larger one
  EXPECT_DOUBLE_EQ(at(0.3, 0.5, "multiply"), 0.15);
  EXPECT_DOUBLE_EQ(at(0.3, 0.5, "lighten"), 0.5);
  EXPECT_DOUBLE_EQ(at(0.3, 0.5, "darken"), 0.3);
  EXPECT_DOUBLE_EQ(at(0.3, 0.5, "add"), 0.8);
  const double grey = std::pow(0.5, 2.2);  // the middle of encoded values changes nothing
  EXPECT_NEAR(at(0.2, grey, "soft_light"), 0.2, 1e-12);
  EXPECT_GT(at(0.2, 0.9, "soft_light"), 0.2);
  EXPECT_LT(at(0.2, 0.01, "overlay"), 0.2);
  EXPECT_DOUBLE_EQ(at(4, 0.1, "soft_light"), 4);
  EXPECT_NEAR(at(0.2, grey, "hard_light"), 0.2, 1e-12);
  EXPECT_LT(at(0.2, 0.01, "hard_light"), 0.01);
  // The one gives its colour, the other its luminance, however bright.
  const Rgb red(0.8, 0.1, 0.05), bright(2, 6, 3);
  for (const char* mode : {"color", "luminosity"}) {
    const Rgb &hue = mode == std::string("color") ? bright : red, &light = mode == std::string("color") ? red : bright;
    const Rgb made = blend(red, bright, mode);
    EXPECT_NEAR(reference::luminance(made), reference::luminance(light), 1e-12) << mode;
    EXPECT_NEAR(made.g / made.r, hue.g / hue.r, 2e-3) << mode;
    EXPECT_NEAR(made.b / made.r, hue.b / hue.r, 2e-3) << mode;
  }
  EXPECT_NEAR(glm::distance(blend(red, Rgb(0), "color"), Rgb(reference::luminance(red))), 0, 1e-6)
      << "black has no colour";
  // Continuous where W3C's formulas end.
  for (const char* mode : {"screen", "overlay", "soft_light", "hard_light"})
    for (const double b : {0.5, 1.0, std::pow(0.25, 2.2), grey})
      for (const double s : {0.2, 0.7, 1.0, 1.5})
        EXPECT_NEAR(at(b - 1e-9, s, mode), at(b + 1e-9, s, mode), 1e-7) << mode;
}

TEST_F(Effects, MasksAgree) {
  const Scene scene = light();
  for (const char* mask :
       {"fx.mask.luma { from = 0.2, to = 1.5, softness = 0.3 }",
        "fx.mask.luma { from = 0.4, softness = 0 }",
        "1 - fx.mask.luma { from = 0.4, to = 0.3, softness = 30 }",
        "fx.mask.hue { center = 30, width = 90 }",
        "fx.mask.hue { center = -100, width = 40, softness = 60, saturation = 0.6 }",
        "fx.mask.depth { from = 1, to = 20, softness = 3 }",
        "fx.mask.radial { }",
        "fx.mask.radial { center = { 0.2, 0.7 }, radius = { 0.5, 0.2 }, softness = 0.4, rotation = 30 }",
        "fx.mask.linear { }",
        "fx.mask.linear { from = { 0.9, 0.1 }, to = { 0.2, 0.6 } }",
        "fx.mask.layer { layer = \"matte\" }",
        "fx.mask.layer { layer = \"matte\", channel = \"luma\" }",
        "fx.mask.id { layer = \"objects\", index = 3 }",
        "fx.mask.id { layer = \"objects\", index = 300, antialias = true }",
        "1 - fx.mask.id { layer = \"objects\", index = 0, antialias = true } - fx.mask.id { layer = \"objects\" }",
        "fx.mask.id { layer = \"objects\", index = 3, feather = 1.5 }",
        "fx.mask.layer { layer = \"matte\", channel = \"g\", feather = 6 }",
        "fx.mask.radial { invert = true }",
        "fx.mask.radial { } + fx.mask.linear { }",
        "fx.mask.radial { } - fx.mask.linear { }",
        "fx.mask.radial { } * fx.mask.luma { }",
        "1 - fx.mask.linear { }",
        "0.5 * fx.mask.linear { } + 0.2",
        "(fx.mask.hue { } + fx.mask.layer { layer = \"matte\", channel = \"g\" }) * (1 - fx.mask.depth { }) - 0.1",
        "0.3"})
    expect_true(fmt::format("fx.color_adjustments {{ post_exposure = 1, saturation = -50, mask = {} }}", mask), scene,
                3e-5);
}

/// Made of smaller masks, which end in other pixels at the border than the whole one does.
TEST_F(Effects, WideFeathersAreGaussians) {
  const Scene scene = light({301, 222});
  for (const double feather : {7.0, 13.0, 30.0}) {
    const std::string entries = fmt::format(
        "fx.exposure {{ ev = 1, mask = fx.mask.id {{ layer = \"objects\", index = 300, feather = {} }} }}", feather);
    const DoubleImage expected = truth(entries, scene);
    const Made made = run_stack(entries, scene, Way::fused);
    ASSERT_TRUE(made.ran());
    const int border = static_cast<int>(2 * feather);
    double inside = 0, anywhere = 0;  // of the mask, which adds as much of the light as it is
    for (int y = 0; y < 222; ++y)
      for (int x = 0; x < 301; ++x) {
        const double light = scene.source.at(x, y).g;
        if (light < 0.1) continue;
        const double off =
            std::abs(made.result[static_cast<std::size_t>(y * 301 + x) * 4 + 1] - expected.at(x, y).g) / light;
        anywhere = std::max(anywhere, off);
        if (x >= border && x < 301 - border && y >= border && y < 222 - border) inside = std::max(inside, off);
      }
    EXPECT_LT(inside, 2e-3) << feather;
    EXPECT_LT(anywhere, 0.1) << feather;
  }
}

// 100 - 1e-6 is 100 in floats, and points may be closer than floats can tell.
TEST_F(Effects, MasksHoldTheirEnds) {
  Scene scene = light();
  double depth = 98;
  for (auto& p : scene.depth->pixels) p = Rgba(depth = depth < 202 ? depth + 0.5 : 98);
  for (const char* mask :
       {"fx.mask.depth { from = 100, to = 200, softness = 0 }", "fx.mask.depth { from = 100, to = 100, softness = 0 }",
        "fx.mask.linear { from = { 0.5, 0.5 }, to = { 0.5, 0.50000001 } }",
        "fx.mask.linear { from = { 0.25, 0.5 }, to = { 0.24999999, 0.5 } }"})
    expect_true(fmt::format("fx.color_adjustments {{ post_exposure = 1, mask = {} }}", mask), scene, 3e-5);
}

TEST_F(Effects, MasksAndBlendsOnEveryKindOfEffect) {
  const Scene scene = light({96, 54});
  for (const char* effect : {"fx.bloom { threshold = 0.6, ", "fx.directional_blur { distance = 5, ",
                             "fx.tone_mapping { ", "fx.vignette { ", "fx.outline { source = \"depth\", "})
    expect_true(std::string(effect) + "opacity = 0.8, mask = fx.mask.radial { } * fx.mask.linear { } }", scene, 5e-5);
  expect_true(
      "fx.bloom { threshold = 0.6, opacity = 0.7, blend = \"screen\" }, fx.tone_mapping { mask = fx.mask.luma { } }",
      scene, 5e-5);
}

TEST_F(Effects, GroupsAndMixesAgree) {
  const Scene scene = light();
  const std::string grade = "fx.color_adjustments { contrast = 20 }", warm = "fx.white_balance { temperature = 40 }";
  expect_true("fx.group { opacity = 0.4, " + grade + ", " + warm + " }", scene, 2e-5);
  expect_true("fx.group { mask = fx.mask.radial { }, blend = \"screen\", " + grade +
                  ", fx.tone_mapping { mode = \"reinhard\" } }, fx.vignette { }",
              scene, 3e-5);
  expect_true("fx.group { opacity = 0.5, fx.group { opacity = 0.5, " + grade + " }, { " + warm + ", false } }", scene,
              2e-5);
  expect_true("fx.mix { { " + grade + " }, { " + warm + ", fx.tone_mapping { mode = \"reinhard\" } }, amount = 0.3 }",
              scene, 2e-5);
  expect_true("fx.mix { fx.stack { " + grade + " }, " + warm +
                  ", amount = fx.curve { { 0, 0.2 }, { 2, 0.4 } }, opacity = 0.5 }",
              scene, 2e-5);
}

TEST_F(Effects, AMaskRunsInTheKernelOfItsEntry) {
  const Scene scene = light({64, 36});
  const auto kernels = [&](const std::string& entries) { return run_stack(entries, scene, Way::fused).kernels; };
  const std::string before = "fx.white_balance { temperature = 20 }, ",
                    behind = ", fx.tone_mapping { mode = \"reinhard\" }";
  EXPECT_EQ(kernels(before + "fx.color_adjustments { contrast = 20 }" + behind), 1u);
  EXPECT_EQ(
      kernels(before +
              "fx.color_adjustments { contrast = 20, opacity = 0.5, mask = fx.mask.luma { } * fx.mask.radial { } + "
              "fx.mask.layer { layer = \"matte\" } }" +
              behind),
      1u);
  EXPECT_EQ(kernels("fx.bloom { threshold = 0.6 }"),
            kernels("fx.bloom { threshold = 0.6, mask = fx.mask.radial { } }"));
}

TEST_F(Effects, WhatCannotBeSeenDoesNotRun) {
  expect_skipped("fx.bloom { opacity = 0 }", "opacity is 0");
  expect_skipped("fx.color_adjustments { contrast = 20, mask = 0 }", "its mask selects nothing");
  expect_skipped("fx.color_adjustments { contrast = 20, mask = fx.mask.radial { radius = { 0, 1 } } }",
                 "its mask selects nothing: radial: radius is 0");
  expect_skipped(
      "fx.color_adjustments { contrast = 20, mask = fx.mask.luma { from = 2, to = 1 } * fx.mask.radial { } }",
      "its mask selects nothing: luma: from is above to");
  expect_skipped("fx.color_adjustments { contrast = 20, mask = 0 - fx.mask.radial { } }", "its mask selects nothing");
  expect_skipped("fx.group { opacity = 0, fx.bloom { } }", "opacity is 0");
}

TEST_F(Effects, FullOpacityAndAFullMaskAreTheEffectItself) {
  const Scene scene = light();
  const std::string effect = "fx.color_adjustments { contrast = 20, saturation = 30";
  const auto plain = run_stack(effect + " }", scene, Way::fused);
  EXPECT_EQ(run_stack(effect + ", opacity = 1, mask = 1 }", scene, Way::fused).result, plain.result);
  EXPECT_TRUE(agrees(run_stack(effect + ", mask = fx.mask.radial { radius = { 9, 9 } } }", scene, Way::fused).result,
                     from_floats(plain.result.data(), plain.size, 4), 1e-6, kRgba));
}

TEST_F(Effects, AFileIsAMask) {
  const Scene scene = light({48, 32});
  Picture picture;
  picture.color = Image(48, 32, 4);
  std::vector<double> red(48 * 32);
  for (std::size_t i = 0; i < red.size(); ++i) {
    picture.color.pixels[4 * i] = static_cast<float>(red[i] = static_cast<double>(i % 17) / 16);
    picture.color.pixels[4 * i + 3] = 1;
  }
  picture.data_window = picture.display_window = {0, 0, 48, 32};
  Diagnostics diagnostics;
  ASSERT_TRUE(write_picture(picture, test_files() / "where.exr", {.type = SampleType::float32}, diagnostics));
  const std::string effect = "fx.color_adjustments { post_exposure = 2";
  const auto all = run_stack(effect + " }", scene, Way::fused);
  const auto expected = composite(scene.source, from_floats(all.result.data(), all.size, 4), 1, "normal", &red);
  for (const Way way : {Way::plain, Way::fused})
    EXPECT_TRUE(agrees(
        run_stack(effect + ", mask = fx.mask.file { file = \"where.exr\", channel = \"r\" } }", scene, way).result,
        expected, 1e-5, kRgb));
  std::vector<double> luma(red);
  for (double& v : luma) v *= 0.2126729;  // of red alone, the weight of math.md §2
  EXPECT_TRUE(agrees(run_stack(effect + ", mask = fx.mask.file { file = \"where.exr\" } }", scene, Way::fused).result,
                     composite(scene.source, from_floats(all.result.data(), all.size, 4), 1, "normal", &luma), 1e-5,
                     kRgb));
  expect_skipped(effect + ", mask = fx.mask.file { } }", "its mask selects nothing: file: no file is named");
}

/// Two ranks an image: an object that covers a disc, one behind it, and none.
TEST_F(Effects, CryptomattesSelectByName) {
  Scene scene = light({48, 32});
  const auto id = [](const char* name) { return static_cast<double>(std::bit_cast<float>(cryptomatte_id(name))); };
  DoubleImage ranks(scene.source.size(), Rgba(0));
  std::vector<double> disc(ranks.pixels.size());
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 48; ++x) {
      const double covered = glm::clamp(10.5 - std::hypot(x - 20.0, y - 16.0), 0.0, 1.0);
      disc[static_cast<std::size_t>(y) * 48 + x] = covered;
      ranks.at(x, y) = covered > 0.5 ? Rgba(id("Suzanne"), covered, id("Floor"), 1 - covered)
                                     : Rgba(id("Floor"), 1 - covered, id("Suzanne"), covered);
    }
  scene.layers["CryptoObject00"] = ranks;
  const std::string effect = "fx.color_adjustments { post_exposure = 2, mask = fx.mask.cryptomatte ";
  const auto all = run_stack("fx.color_adjustments { post_exposure = 2 }", scene, Way::fused);
  const auto expected = composite(scene.source, from_floats(all.result.data(), all.size, 4), 1, "normal", &disc);
  for (const Way way : {Way::plain, Way::fused}) {
    EXPECT_TRUE(agrees(run_stack(effect + "{ names = \"Suzanne\" } }", scene, way).result, expected, 1e-5, kRgb));
    EXPECT_TRUE(agrees(run_stack(effect + "{ names = \"Suzanne, Floor\" } }", scene, way).result,
                       from_floats(all.result.data(), all.size, 4), 1e-5, kRgb));
    EXPECT_TRUE(agrees(run_stack(effect + "{ names = \"Suzanne\", invert = true } * 1 }", scene, way).result,
                       composite(from_floats(all.result.data(), all.size, 4), scene.source, 1, "normal", &disc), 1e-5,
                       kRgb));
  }
  EXPECT_EQ(run_stack(effect + "{ names = \"Monkey\" } }", scene, Way::fused).result,
            run_stack("fx.color_adjustments { }", scene, Way::fused).result);
}

}  // namespace
}  // namespace afterglow
