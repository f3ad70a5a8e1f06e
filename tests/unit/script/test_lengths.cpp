// SPDX-License-Identifier: MIT
// Settings in px are lengths of the delivered picture: what effects read of them in a picture that runs smaller or
// larger.
#include <gtest/gtest.h>

#include "scene.h"

namespace afterglow::test {
namespace {

struct Lengths : testing::Test {
  Lengths() {
    // The image that it makes has the sides that it read, times eight.
    scene.effect("probe", R"(
  settings = {
    radius = fx.float { min = 2, default = 8, unit = "px" }, lines = fx.int { min = 3, default = 12, unit = "px" },
    shift = fx.vec2 { default = { 4, 6 }, unit = "px" }, share = fx.float { default = 8 },
  },
  build = function(g, s, source)
    g:skip(("%g %g %g %g %g %g"):format(s.radius, s.lines, s.shift[1], s.shift[2], s.share, g.length_scale))
    return source
  end,)");
  }
  /// "radius lines shift share scale" as the effect reads them in a picture that is 64 high.
  std::string read(double scale) {
    auto preset = scene.load();
    EXPECT_TRUE(preset.ok());
    if (!preset.ok()) return preset.error().text();
    std::string all;
    // Twice, and once at another scale between: nothing of a scale stays.
    for (const double now : {scale, 3.0, scale}) {
      BuildContext context;
      context.size = {64, 64};
      context.length_scale = now;
      Diagnostics quiet;
      const auto build = preset->evaluate(context, quiet);
      EXPECT_TRUE(build.ok());
      const std::string text = build.ok() ? build->graph.skipped.at(0).reason : build.error().text();
      if (now != scale) continue;
      EXPECT_TRUE(all.empty() || all == text) << text;
      all = text;
    }
    return all;
  }
  Scene scene;
};

TEST_F(Lengths, ScaleWithThePicture) {
  scene.stack("fx.probe {}");
  EXPECT_EQ(read(1), "8 12 4 6 8 1");
  EXPECT_EQ(read(0.5), "4 6 2 3 8 0.5");
  EXPECT_EQ(read(0.125), "1 3 0.5 0.75 8 0.125");  // numbers go below their least value, counts do not
  EXPECT_EQ(read(2), "16 24 8 12 8 2");
}

TEST_F(Lengths, AStackMayGiveThemForOneHeight) {
  scene.preset("local fx = require \"afterglow\"\nreturn fx.stack { reference_height = 32, fx.probe {} }");
  for (const double scale : {1.0, 0.25}) EXPECT_EQ(read(scale), "16 24 8 12 8 2");
}

TEST_F(Lengths, OnlyASmallerPictureIsAPreview) {
  scene.effect("probe", "build = function(g, s, source) g:skip((\"%g\"):format(g.preview_scale)) return source end,");
  scene.preset("local fx = require \"afterglow\"\nreturn fx.stack { reference_height = 32, fx.probe {} }");
  EXPECT_EQ(read(1), "1");
  EXPECT_EQ(read(0.25), "0.25");
}

TEST_F(Lengths, Messages) {
  const auto error = [&](const std::string& key) {
    scene.preset("local fx = require \"afterglow\"\nreturn fx.stack {\n  " + key + ", fx.probe {} }");
    return scene.load_error();
  };
  EXPECT_EQ(error("reference_height = 0"),
            "preset.lua:3: error: fx.stack: reference_height = 0 is out of range; allowed: 1…16384");
  EXPECT_EQ(error("alpha = \"asociated\""),
            "preset.lua:3: error: fx.stack: alpha = \"asociated\"; allowed: straight, associated; did you mean "
            "'associated'?");
  EXPECT_EQ(error("gamut = \"kepe\""),
            "preset.lua:3: error: fx.stack: gamut = \"kepe\"; allowed: cut, keep; did you mean 'keep'?");
  EXPECT_EQ(
      error("input_space = \"logc\""),
      "preset.lua:3: error: fx.stack: input_space: 'logc' is no input space; allowed: aces2065_1, acescct, acescg, "
      "adobe_rgb, apple_log, bmd_film5, cineon, clog2, clog3, davinci_intermediate, display_p3, gamma22, gamma24, hlg, "
      "hlg_1000, lin_p3d65, lin_rec2020, linear, log3g10, logc3, logc4, pq, rec709, slog3, slog3_sgamut3, srgb, vlog; "
      "did you "
      "mean 'logc3'?");
}

}  // namespace
}  // namespace afterglow::test
