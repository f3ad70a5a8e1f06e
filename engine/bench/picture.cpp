// SPDX-License-Identifier: MIT
#include "bench/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/half.h"
#include "core/parallel.h"

namespace afterglow::bench {
namespace {

using Rgb = std::array<float, 3>;

/// In units of the picture's height; x and y from the centre.
struct Sphere {
  float x, y, radius, depth;
  Rgb color;
  float light;  ///< above 0: a lamp that shines by itself
};
constexpr Sphere kSpheres[] = {
    {-0.55f, 0.12f, 0.26f, 6.0f, {0.70f, 0.25f, 0.15f}, 0}, {0.05f, 0.20f, 0.22f, 5.0f, {0.15f, 0.45f, 0.70f}, 0},
    {0.60f, 0.08f, 0.30f, 7.0f, {0.55f, 0.55f, 0.50f}, 0},  {-0.15f, -0.25f, 0.05f, 4.0f, {1.0f, 0.85f, 0.6f}, 40},
    {0.38f, -0.33f, 0.03f, 4.5f, {0.4f, 0.7f, 1.0f}, 25},   {-0.72f, -0.30f, 0.04f, 4.2f, {1.0f, 0.3f, 0.2f}, 12},
    {0.78f, -0.22f, 0.008f, 4.0f, {1.0f, 1.0f, 1.0f}, 35},
};

/// Grain: 0…1 from the position alone.
float noise(int x, int y) {
  std::uint32_t h = static_cast<std::uint32_t>(x) * 0x9e3779b1u ^ static_cast<std::uint32_t>(y) * 0x85ebca6bu;
  h = (h ^ (h >> 15)) * 0x2c1b3c6du;
  h = (h ^ (h >> 12)) * 0x297a2d39u;
  return static_cast<float>((h ^ (h >> 15)) >> 8) / 16777216.0f;
}

float half_exact(float value) { return float_from_half(half_from_float(value)); }

struct Surface {
  Rgb color{};
  float depth = 20;
  Rgb normal{0, 0, -1};
};

Surface look(float x, float y) {
  Surface s;
  const float stripes = 0.5f + 0.5f * std::sin(23.0f * x) * std::sin(17.0f * y);
  s.color = {0.05f + 0.05f * stripes, 0.06f + 0.03f * stripes, 0.10f + 0.02f * stripes};
  if (std::abs(y + 0.42f) < 0.006f && std::abs(x) < 0.8f) s.color = {9.0f, 1.5f, 6.0f};  // a tube
  for (const auto& sphere : kSpheres) {
    const float u = (x - sphere.x) / sphere.radius, v = (y - sphere.y) / sphere.radius, r2 = u * u + v * v;
    if (r2 >= 1 || s.depth < sphere.depth) continue;
    const float w = std::sqrt(1 - r2);
    s.normal = {u, v, -w};
    s.depth = sphere.depth - w * sphere.radius;
    const float shade =
        sphere.light > 0 ? sphere.light : 0.05f + 1.6f * std::max(0.0f, -0.4f * u - 0.6f * v + 0.7f * w);
    for (int c = 0; c < 3; ++c) s.color[c] = sphere.color[c] * shade;
  }
  return s;
}

}  // namespace

Picture make_picture(Size size) {
  Picture picture;
  picture.color = Image(size.width, size.height, 4);
  Image& depth = picture.auxiliary["depth"] = Image(size.width, size.height, 1);
  Image& normal = picture.auxiliary["normal"] = Image(size.width, size.height, 3);
  picture.data_window = picture.display_window = {0, 0, size.width, size.height};
  const auto height = static_cast<float>(size.height);
  parallel_rows(size.height, size.area() * 8, [&](int begin, int end) {
    for (int y = begin; y < end; ++y)
      for (int x = 0; x < size.width; ++x) {
        const Surface s = look((static_cast<float>(x) + 0.5f - 0.5f * static_cast<float>(size.width)) / height,
                               (static_cast<float>(y) + 0.5f) / height - 0.5f);
        const float grain = 0.85f + 0.3f * noise(x, y);
        for (int c = 0; c < 3; ++c) {
          picture.color.at(x, y)[c] = half_exact(s.color[c] * grain);
          normal.at(x, y)[c] = s.normal[c];
        }
        picture.color.at(x, y)[3] = 1;
        *depth.at(x, y) = s.depth;
      }
  });
  return picture;
}

}  // namespace afterglow::bench
