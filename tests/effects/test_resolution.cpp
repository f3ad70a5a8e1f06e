// SPDX-License-Identifier: MIT
// One scene at several resolutions: with a reference height the glow is the same, without it is not.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness.h"

namespace afterglow {
namespace {

using namespace reference;

/// Lamps on a dark ground, in units of the picture's height, each pixel the mean of 8×8 points.
Scene lamps(Size size) {
  constexpr struct {
    double x, y, radius, light;
  } kLamps[] = {{0.31, 0.42, 0.05, 8}, {0.92, 0.3, 0.012, 30}, {1.31, 0.71, 0.1, 3}, {0.63, 0.83, 0.02, 12}};
  const double h = size.height;
  return {fmt::format("lamps {}", size.height),
          in_floats(generate(size,
                             [&](int x, int y) {
                               double sum = 0;
                               for (int i = 0; i < 64; ++i) {
                                 const double px = (x + (i % 8 + 0.5) / 8) / h, py = (y + (i / 8 + 0.5) / 8) / h;
                                 double light = 0.05;
                                 for (const auto& lamp : kLamps)
                                   if (std::hypot(px - lamp.x, py - lamp.y) < lamp.radius) light = lamp.light;
                                 sum += light;
                               }
                               return Rgba(sum / 64, 0.8 * sum / 64, 0.6 * sum / 64, 1);
                             })),
          {},
          {}};
}

/// What the stack adds, as means over pixels of a picture `factor` times smaller.
std::vector<double> glow(const std::string& entries, Size size, int factor) {
  const Scene scene = lamps(size);
  const Made made = run_stack(entries, scene, Way::fused);
  std::vector<double> out;
  for (int y = 0; y < size.height / factor; ++y)
    for (int x = 0; x < size.width / factor; ++x) {
      double sum = 0;
      for (int v = 0; v < factor; ++v)
        for (int u = 0; u < factor; ++u) {
          const int px = x * factor + u, py = y * factor + v;
          sum += made.result[static_cast<std::size_t>(py * size.width + px) * 4] - scene.source.at(px, py).r;
        }
      out.push_back(sum / (factor * factor));
    }
  return out;
}

/// The largest difference, as a share of the largest glow. Pixels at the edge of a lamp do not count: there the light
/// of a pixel is a mean of the lamp's and the ground's, and a threshold of a mean is no mean of thresholds.
double worst(const std::vector<double>& a, const std::vector<double>& b, Size size) {
  const Scene scene = lamps(size);
  double most = 0, largest = 0;
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      bool even = true;
      for (int i = 0; i < 9; ++i)
        even = even && scene.source.clamped(x + i % 3 - 1, y + i / 3 - 1) == scene.source.at(x, y);
      const auto at = static_cast<std::size_t>(y * size.width + x);
      if (even) most = std::max(most, std::abs(a[at] - b[at]));
      largest = std::max(largest, std::abs(b[at]));
    }
  return most / largest;
}

TEST_F(Effects, AReferenceHeightMakesTheGlowThatOfEveryResolution) {
  constexpr double kBound = 0.02;  // docs/benchmarks/stability.md
  for (const std::string mode : {"additive", "scattering"}) {
    const std::string plain = fmt::format("fx.bloom {{ mode = \"{}\", intensity = 0.5 }}", mode);
    const std::string fixed =
        fmt::format("fx.bloom {{ mode = \"{}\", intensity = 0.5, reference_height = 135 }}", mode);
    const Size base{240, 135};
    const auto small = glow(fixed, base, 1), before = glow(plain, base, 1);
    for (const int factor : {2, 3}) {
      const Size size{base.width * factor, base.height * factor};
      const double with = worst(glow(fixed, size, factor), small, base),
                   without = worst(glow(plain, size, factor), before, base);
      EXPECT_LT(with, kBound) << mode << " " << size.height;
      EXPECT_GT(without, 2 * kBound) << mode << " " << size.height << ": the test has something to measure";
    }
  }
}

TEST_F(Effects, ASmallLightWeighsTheSameWhereverItLies) {
  // One bright pixel at each place of the grid, under a ratio that is no whole number.
  const Size size{120, 80};
  double least = 1e30, most = 0;
  for (int y = 30; y < 36; ++y)
    for (int x = 50; x < 56; ++x) {
      Scene scene{"light", DoubleImage(size, Rgba(0, 0, 0, 1)), {}, {}};
      scene.source.at(x, y) = Rgba(1000, 1000, 1000, 1);
      const Made made =
          run_stack("fx.bloom { threshold = 0, knee = 0, intensity = 1, reference_height = 56 }", scene, Way::fused);
      double sum = -1000;
      for (std::size_t i = 0; i < made.result.size(); i += 4) sum += made.result[i];
      least = std::min(least, sum);
      most = std::max(most, sum);
    }
  EXPECT_LT(most / least, 1.15);
}

}  // namespace
}  // namespace afterglow
