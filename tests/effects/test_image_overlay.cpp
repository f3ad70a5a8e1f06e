// SPDX-License-Identifier: MIT
// A picture over the picture: every fit and blend mode as the oracle has it, where it stands, what a sequence of them
// does.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "cases.h"
#include "files.h"
#include "reference/image_overlay.h"

namespace afterglow {
namespace {

using namespace reference;
using ::testing::HasSubstr;

EffectCase laid(const std::string& file, const DoubleImage& over, const ImageOverlay& v) {
  constexpr const char* kFits[] = {"contain", "cover", "stretch", "tile"};
  return {fmt::format(
              "fx.image_overlay {{ file = \"{}\", blend = \"{}\", fit = \"{}\", size = {}, position = {{ {}, {} }}, "
              "margin = {}, intensity = {} }}",
              file, v.blend, kFits[static_cast<int>(v.fit)], v.size, v.x, v.y, v.margin, v.intensity),
          [=](const Scene& s) { return image_overlay(s.source, over, v); }};
}

TEST_F(Effects, ImageOverlayAgrees) {
  const DoubleImage small = write_test_picture("small.exr", {7, 5}),
                    large = write_test_picture("large.exr", {101, 67}, 3),
                    line = write_test_picture("line.exr", {1, 9});
  using Fit = ImageOverlay::Fit;
  agree_everywhere({laid("small.exr", small, {}), laid("large.exr", large, {}),
                    laid("large.exr", large, {.size = 0.3, .x = 1, .y = 1, .margin = 0.05}),
                    laid("small.exr", small, {.fit = Fit::cover, .x = 0.25, .intensity = 2}),
                    laid("large.exr", large, {.fit = Fit::cover, .size = 1.7, .x = 0, .y = 0}),
                    laid("line.exr", line, {.fit = Fit::stretch, .margin = 0.4}),
                    laid("small.exr", small, {.fit = Fit::tile, .x = 0.9, .y = 0.2}),
                    laid("small.exr", small, {.fit = Fit::tile, .size = 2.4}),
                    laid("large.exr", large, {.fit = Fit::tile, .size = 0.21})},
                   kBetweenPixels);
  for (const char* blend :
       {"add", "screen", "multiply", "overlay", "soft_light", "lighten", "darken", "hard_light", "color", "luminosity"})
    agree_everywhere({laid("large.exr", large, {.blend = blend, .fit = Fit::stretch})}, kBetweenPixels);
  expect_skipped("fx.image_overlay { }", "file is not given");
}

/// A logo that needs no other size is there texel for texel.
TEST_F(Effects, ImageOverlayKeepsTexels) {
  const DoubleImage logo = write_test_picture("logo.exr", {20, 10});
  Scene scene = random_scene({40, 20}, 3);
  const Made made =
      run_stack("fx.image_overlay { file = \"logo.exr\", size = 0.5, position = { 1, 0 } }", scene, Way::fused);
  EXPECT_EQ(made.graph.passes.size(), 1U) << "nothing is resized";
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 20; ++x) {
      const Rgba over = logo.at(x, y);
      if (over.a == 1) {
        EXPECT_EQ(made.result[4 * static_cast<std::size_t>(y * 40 + x + 20)], static_cast<float>(over.r));
      }
    }
}

TEST_F(Effects, ImageOverlayMayBeASequence) {
  write_test_picture("leak.0001.exr", {8, 8});
  write_test_picture("leak.0002.exr", {8, 8}, 4);
  const std::string of = "fx.image_overlay { fit = \"cover\", file = ";
  Scene scene = random_scene({32, 18}, 3);
  for (const int frame : {1, 2}) {
    scene.frame = frame;
    EXPECT_EQ(run_stack(of + "function(t) return (\"leak.%04d.exr\"):format(t.frame) end }", scene, Way::fused).result,
              run_stack(of + fmt::format("\"leak.{:04}.exr\" }}", frame), scene, Way::fused).result);
  }
  EXPECT_THAT(build_error(of + "\"leak.0003.exr\" }", scene), HasSubstr("leak.0003.exr"));
}

}  // namespace
}  // namespace afterglow
