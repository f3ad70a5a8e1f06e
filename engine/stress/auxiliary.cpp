// SPDX-License-Identifier: MIT
#include "stress/auxiliary.h"

#include <array>
#include <cmath>
#include <limits>

namespace afterglow::stress {
namespace {

constexpr float kBackground = 1e10f;

struct Surface {
  float depth;
  std::array<float, 3> normal;
  std::array<float, 2> motion;
};

Surface random_surface(Random& random) {
  Surface out{};
  out.depth = random.chance(0.1) ? kBackground : static_cast<float>(random.log_between(0.5, 1500));
  std::array<double, 3> n{};
  double length = 0;
  for (double& v : n) {
    v = random.between(-1.0, 1.0);
    length += v * v;
  }
  length = std::sqrt(std::max(length, 1e-6));
  for (int i = 0; i < 3; ++i) out.normal[i] = static_cast<float>(n[i] / length);
  if (random.chance(0.7))
    for (float& v : out.motion) v = static_cast<float>(random.between(-40.0, 40.0));
  return out;
}

Surface hard_surface(Random& random) {
  static const std::vector<float> kDepths{0.0f,
                                          -0.0f,
                                          1e-38f,
                                          1e-6f,
                                          1.0f,
                                          65504.0f,
                                          1e10f,
                                          1e30f,
                                          -1.0f,
                                          0.5f,
                                          std::numeric_limits<float>::infinity(),
                                          std::numeric_limits<float>::quiet_NaN()};
  static const std::vector<float> kDirections{
      0.0f, 1.0f, -1.0f, 1e30f, -1e30f, 1e-38f, std::numeric_limits<float>::quiet_NaN()};
  static const std::vector<float> kMotions{0.0f, 0.4f, 1e-38f, 16384.0f, -16384.0f, 1e30f, -1e30f, 3.0f};
  Surface out{};
  out.depth = random.pick(kDepths);
  for (float& v : out.normal) v = random.pick(kDirections);
  for (float& v : out.motion) v = random.pick(kMotions);
  return out;
}

}  // namespace

std::map<std::string, Size> auxiliary_sizes(Size size) {
  return {{"depth", size}, {"normal", size}, {"motion", size}, {kMatte, size}};
}

void add_auxiliary(Picture& picture, Random& random, bool gentle) {
  const int width = picture.color.width, height = picture.color.height;
  Image depth(width, height, 1), normal(width, height, 3), motion(width, height, 2), matte(width, height, 4);
  std::vector<Surface> surfaces;
  for (int i = 0; i < 64; ++i) surfaces.push_back(gentle ? random_surface(random) : hard_surface(random));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Surface& s = surfaces[static_cast<std::size_t>((x / 5 * 5 + y / 4 * 11) % 64)];
      depth.at(x, y)[0] = s.depth;
      for (int c = 0; c < 3; ++c) normal.at(x, y)[c] = s.normal[static_cast<std::size_t>(c)];
      for (int c = 0; c < 2; ++c) motion.at(x, y)[c] = s.motion[static_cast<std::size_t>(c)];
    }
  for (std::size_t i = 0; i < matte.pixels.size(); ++i)
    matte.pixels[i] = random.chance(0.2) ? 0.0f : random.chance(0.2) ? 1.0f : static_cast<float>(random.unit());
  picture.auxiliary = {{"depth", std::move(depth)},
                       {"normal", std::move(normal)},
                       {"motion", std::move(motion)},
                       {kMatte, std::move(matte)}};
}

}  // namespace afterglow::stress
