// SPDX-License-Identifier: MIT
// The golden values (math.md §14) through the device.
#include <fmt/format.h>

#include <fstream>
#include <map>
#include <sstream>

#include "harness.h"

namespace afterglow {
namespace {

using namespace reference;

struct Rows {
  std::vector<Rgb> in, out;
};

std::map<std::string, Rows> golden_values() {
  std::map<std::string, Rows> values;
  std::ifstream file(AFTERGLOW_TEST_FOLDER "/golden_values.txt");
  for (std::string line; std::getline(file, line);) {
    auto& rows = values[line.substr(0, line.find_last_not_of(' ', 14) + 1)];
    Rgb in, out;
    char comma;
    std::string arrow;
    std::istringstream(line.substr(15)) >> in.r >> comma >> in.g >> comma >> in.b >> arrow >> out.r >> out.g >> out.b;
    rows.in.push_back(in);
    rows.out.push_back(out);
  }
  return values;
}

/// A block of 8×8 pixels for each colour, so that halving keeps its middle.
DoubleImage blocks(const std::vector<Rgb>& colours, int side) {
  return generate({static_cast<int>(colours.size()) * side, side},
                  [&](int x, int) { return Rgba(colours[static_cast<std::size_t>(x / side)], 1); });
}

TEST_F(Effects, GoldenValuesOfColourEffects) {
  const std::pair<const char*, const char*> kEntries[] = {
      {"reinhard", "fx.tone_mapping { mode = \"reinhard\" }"},
      {"neutral", "fx.tone_mapping { mode = \"neutral\" }"},
      {"aces", "fx.tone_mapping { mode = \"aces\" }"},
      {"contrast+50", "fx.color_adjustments { contrast = 50 }"},
      {"hue+60", "fx.color_adjustments { hue_shift = 60 }"},
      {"sat+50", "fx.color_adjustments { saturation = 50 }"},
  };
  const auto golden = golden_values();
  for (const auto& [name, entry] : kEntries) {
    auto rows = golden.at(name);
    ASSERT_EQ(rows.in.size(), 12u);
    if (std::string(entry).find("color_adjustments") != std::string::npos)
      for (auto& c : rows.out) c = glm::max(c, Rgb(0));  // the golden values are those of the step alone
    const Scene scene{name, blocks(rows.in, 1), {}, {}};
    const double tolerance = std::string(name) == "hue+60" ? 5e-5 : kFullFloat;  // greys and primaries are ties
    EXPECT_TRUE(agrees(run_stack(entry, scene, Way::plain).result, blocks(rows.out, 1), tolerance, kRgb)) << name;
  }
}

TEST_F(Effects, GoldenValuesOfTheThreshold) {
  const auto rows = golden_values().at("thresh 1/.5");
  const Scene scene{"blocks", blocks(rows.in, 8), {}, {}};
  const Made made = run_stack("fx.bloom { threshold = 1, knee = 0.5 }", scene, Way::plain);
  const auto image = made.image("bloom.prefilter");
  for (std::size_t i = 0; i < rows.in.size(); ++i)
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(image.at(static_cast<int>(4 * i + 2), 2)[c], rows.out[i][c], 1e-5 * (rows.out[i][c] + 0.01)) << i;
}

}  // namespace
}  // namespace afterglow
