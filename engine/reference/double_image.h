// SPDX-License-Identifier: MIT
// Pictures in double precision and the ways to sample them (math.md §1). The ground that every oracle of this room
// stands on: plain loops over plain definitions, written from the mathematics and sharing nothing with the shaders that
// they check. All functions of this room are pure and thread-safe; they trust their arguments (sizes ≥ 1, images not
// empty).
#pragma once

#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "core/alpha.h"
#include "core/filter.h"
#include "core/geometry.h"
#include "core/parallel.h"

namespace afterglow::reference {

using Rgb = glm::dvec3;
using Rgba = glm::dvec4;

/// RGBA samples, row by row from the top. Depth lies in .r, a normal in .rgb.
struct DoubleImage {
  int width = 0, height = 0;
  std::vector<Rgba> pixels;

  DoubleImage() = default;
  DoubleImage(int w, int h, Rgba value = Rgba(0, 0, 0, 1))
      : width(w), height(h), pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), value) {}
  explicit DoubleImage(Size size, Rgba value = Rgba(0, 0, 0, 1)) : DoubleImage(size.width, size.height, value) {}

  Size size() const { return {width, height}; }
  Rgba& at(int x, int y) { return pixels[static_cast<std::size_t>(y) * width + x]; }
  const Rgba& at(int x, int y) const { return pixels[static_cast<std::size_t>(y) * width + x]; }
  /// The texel, coordinates clamped to the edge.
  const Rgba& clamped(int x, int y) const { return at(glm::clamp(x, 0, width - 1), glm::clamp(y, 0, height - 1)); }
  /// The same, or the texel where the image is mirrored at its edges, again and again.
  const Rgba& beyond(int x, int y, Edges edges) const {
    return edges == Edges::mirror ? at(folded(x, width), folded(y, height)) : clamped(x, y);
  }

 private:
  static int folded(int i, int n) {
    while (i < 0 || i >= n) i = i < 0 ? -1 - i : 2 * n - 1 - i;
    return i;
  }
};

/// From interleaved floats. Channels that are missing become 0, alpha 1.
DoubleImage from_floats(const float* pixels, Size size, int channels);

/// Interleaved RGBA, for comparing with a device's result.
std::vector<double> interleaved(const DoubleImage& image);

/// Texel-space position of the centre of target pixel `target` on an axis: (target + ½)·n_src/n_dst. The product is
/// taken in integers, so that texel centres and corners are met exactly.
inline double source_position(int target, int n_src, int n_dst) {
  return static_cast<double>((2LL * target + 1) * n_src) / static_cast<double>(2LL * n_dst);
}

/// The texel that covers (px, py).
Rgba sample_nearest(const DoubleImage& image, double px, double py, Edges edges = Edges::stretch);
/// Bilinear at texel-space position (px, py).
Rgba sample_linear(const DoubleImage& image, double px, double py, Edges edges = Edges::stretch);
/// Cubic B-spline over the 4×4 texels around (px, py). Reproduces constants and, away from edges, ramps.
Rgba sample_bspline(const DoubleImage& image, double px, double py, Edges edges = Edges::stretch);

/// Weights of the cubic B-spline for texels c−2 … c+1, t ∈ [0, 1) the position behind the centre of texel c−1.
glm::dvec4 bspline_weights(double t);

/// A new image of `size` whose pixel (x, y) is f(x, y). f is called from several threads at once.
template <class F>
DoubleImage generate(Size size, F&& f) {
  DoubleImage out(size);
  parallel_rows(size.height, 4LL * size.area(), [&](int begin, int end) {
    for (int y = begin; y < end; ++y)
      for (int x = 0; x < size.width; ++x) out.at(x, y) = f(x, y);
  });
  return out;
}

/// `image` with its colour replaced by f(colour); alpha kept. f is called from several threads at once.
template <class F>
DoubleImage map_color(const DoubleImage& image, F&& f) {
  return generate(image.size(), [&](int x, int y) {
    const Rgba& p = image.at(x, y);
    return Rgba(f(Rgb(p)), p.a);
  });
}

/// What straight colour is divided by: alpha, at most 65504, or 1 where there is none (math.md §19).
inline double cover(const Rgba& p) { return cover_of(p.a); }

/// As `map_color` with f seeing straight colour: divided by alpha before, multiplied by it behind. Where alpha is 0,
/// without what f makes of black.
template <class F>
DoubleImage map_straight(const DoubleImage& image, F&& f) {
  return generate(image.size(), [&](int x, int y) {
    const Rgba& p = image.at(x, y);
    const Rgb made = f(Rgb(p) / cover(p));
    if (p.a >= double(kLeastAlpha)) return Rgba(made * cover(p), p.a);
    return Rgba(glm::max(made - f(Rgb(0)), glm::min(made, 0.0)), p.a);
  });
}

}  // namespace afterglow::reference
