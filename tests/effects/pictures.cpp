// SPDX-License-Identifier: MIT
#include "pictures.h"

#include <fmt/format.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "image/reader.h"

namespace afterglow {
namespace {

using reference::DoubleImage;
using reference::Rgba;

double to_half(double v) {
  if (v == 0) return 0;
  const int exponent = std::max(std::ilogb(v), -14) - 10;
  return std::min(std::ldexp(std::nearbyint(std::ldexp(v, -exponent)), exponent), 65504.0);
}

template <class F>
void round_all(DoubleImage& image, F&& round) {
  for (auto& p : image.pixels)
    for (int c = 0; c < 4; ++c) p[c] = round(p[c]);
}

DoubleImage crop(const Image& image, Size size, int x, int y) {
  DoubleImage out(size);
  for (int j = 0; j < size.height; ++j)
    for (int i = 0; i < size.width; ++i)
      for (int c = 0; c < std::min(image.channels, 4); ++c)
        out.at(i, j)[c] = static_cast<double>(image.at(x + i, y + j)[c]);
  return out;
}

}  // namespace

DoubleImage in_floats(const DoubleImage& image) {
  // Through memory: GCC 12 -O2 drops the rounding of static_cast<double>(static_cast<float>(v)) when it joins two of
  // them.
  const auto values = reference::interleaved(image);
  const std::vector<float> floats(values.begin(), values.end());
  return reference::from_floats(floats.data(), image.size(), 4);
}

Scene random_scene(Size size, unsigned seed, bool spikes) {
  std::mt19937 generator(seed * 7919u + static_cast<unsigned>(size.width));
  std::uniform_real_distribution<double> uniform(0, 1);
  std::normal_distribution<double> normal(0, 1);
  Scene scene;
  scene.name = fmt::format("random {}x{} seed {}{}", size.width, size.height, seed, spikes ? " with spikes" : "");
  scene.source = DoubleImage(size);
  for (auto& p : scene.source.pixels) {
    const double light = std::min(std::exp(-1.2 + 1.4 * normal(generator)), 43.0);
    p = Rgba(0, 0, 0, uniform(generator));
    for (int c = 0; c < 3; ++c) p[c] = light * (0.15 + 0.85 * uniform(generator));
    if (spikes && uniform(generator) < 0.005) p[static_cast<int>(3 * uniform(generator))] = 1e4;
  }
  round_all(scene.source, to_half);

  // Blocks of one surface each, so that there are edges and insides.
  scene.depth = DoubleImage(size);
  scene.normal = DoubleImage(size);
  std::vector<Rgba> depths, normals;
  for (int i = 0; i < 64; ++i) {
    depths.emplace_back(uniform(generator) < 0.1 ? 1e10 : 0.5 * std::pow(3000.0, uniform(generator)), 0, 0, 1);
    const auto n = glm::normalize(reference::Rgb(normal(generator), normal(generator), normal(generator)));
    normals.emplace_back(n, 1);
  }
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const auto block = static_cast<std::size_t>((x / 3 * 5 + y / 4 * 11) % 64);
      scene.depth->at(x, y) = depths[block] * (1 + 0.01 * uniform(generator));
      scene.normal->at(x, y) = normals[block] + 0.02 * uniform(generator);
    }
  scene.depth = in_floats(*scene.depth);
  scene.normal = in_floats(*scene.normal);
  return scene;
}

Scene neon_scene(Size size, int x, int y) {
  Diagnostics quiet;
  ReadOptions options;
  options.auxiliary = {"depth", "normal"};
  static const auto picture = read_picture(AFTERGLOW_TEST_FOLDER "/images/neon.exr", options, quiet);
  if (!picture.ok()) throw std::runtime_error(picture.error().text());
  Scene scene;
  scene.name = fmt::format("neon {}x{} at {} {}", size.width, size.height, x, y);
  scene.source = crop(picture->color, size, x, y);
  scene.depth = crop(picture->auxiliary.at("depth"), size, x, y);
  scene.normal = crop(picture->auxiliary.at("normal"), size, x, y);
  return scene;
}

}  // namespace afterglow
