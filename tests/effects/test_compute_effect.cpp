// SPDX-License-Identifier: MIT
// The effect with compute shaders that docs/writing_effects.md shows, taken from its text, against double precision.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "core/text.h"
#include "files.h"
#include "harness.h"
#include "pictures.h"

namespace afterglow {
namespace {

using namespace reference;

/// Writes the block of the guide that begins with "MARK effects/x.lua" below the folder of test files, beside the
/// stack.
void write_documented(const std::string& file, const std::string& mark) {
  std::ifstream in(std::filesystem::path(AFTERGLOW_PROJECT_FOLDER) / "docs/writing_effects.md");
  std::stringstream guide;
  guide << in.rdbuf();
  const std::string text = guide.str(), first = "\n" + mark + " " + file + "\n";
  const std::size_t begin = text.find(first);
  ASSERT_NE(begin, std::string::npos) << "the guide does not show " << file;
  write_test_file(file, text.substr(begin + 1, text.find("\n```", begin) - begin));
}

DoubleImage stretched(const DoubleImage& source, double white) {
  double most = 0;
  for (const auto& p : source.pixels) most = std::max({most, p.r, p.g, p.b});
  DoubleImage out = source;
  for (auto& p : out.pixels) p = Rgba(Rgb(p) * (white / std::max(most, 1e-20)), p.a);
  return out;
}

TEST_F(Effects, TheGuidesComputeEffectAgrees) {
  write_documented("effects/stretch.lua", "--");
  write_documented("shaders/stretch/brightest.glsl", "//");
  write_documented("shaders/stretch/scale.glsl", "//");
  for (const Size size : {Size{1, 1}, Size{1, 7}, Size{7, 1}, Size{64, 64}, Size{101, 57}, Size{301, 130}}) {
    const Scene scene = random_scene(size, 21);
    const DoubleImage expected = stretched(scene.source, 2.5);
    for (const Way way : {Way::plain, Way::fused, Way::fused_half}) {
      const Made made = run_stack("fx.stretch { white = 2.5 }", scene, way);
      EXPECT_EQ(made.dispatches, 2u);
      EXPECT_TRUE(agrees(made.result, expected, way == Way::fused_half ? kHalfFloat : 1e-6, kRgb))
          << size.width << 'x' << size.height;
    }
  }
  Scene scene = random_scene({16, 16}, 3);
  const Made alone = run_stack("fx.stretch {}, fx.exposure { ev = 1, order = 70 }", scene, Way::fused);
  EXPECT_TRUE(agrees(alone.result, stretched(scene.source, 2), 1e-6, kRgb));
}

}  // namespace
}  // namespace afterglow
