// SPDX-License-Identifier: MIT
#include "reference/image_overlay.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec2.hpp>

#include "reference/composite.h"
#include "reference/resample.h"

namespace afterglow::reference {
namespace {

/// Where the picture lies: its corner and size in pixels.
struct Place {
  glm::ivec2 corner{0}, size{1};
};

Place place_of(Size target, Size over, const ImageOverlay& s) {
  const bool tiles = s.fit == ImageOverlay::Fit::tile;
  const double margin = tiles ? 0 : std::min(s.margin * target.height, 0.4 * target.width);
  const glm::dvec2 room(target.width - 2 * margin, target.height - 2 * margin);
  glm::dvec2 scale = room / glm::dvec2(over.width, over.height);
  if (s.fit == ImageOverlay::Fit::contain) scale = glm::dvec2(std::min(scale.x, scale.y));
  if (s.fit == ImageOverlay::Fit::cover) scale = glm::dvec2(std::max(scale.x, scale.y));
  if (tiles) scale = glm::dvec2(s.tile_scale);
  const glm::dvec2 size = glm::max(glm::floor(glm::dvec2(over.width, over.height) * scale * s.size + 0.5), 1.0);
  return {glm::ivec2(glm::floor(margin + glm::dvec2(s.x, s.y) * (room - size) + 0.5)), glm::ivec2(size)};
}

int wrapped(int i, int n) { return ((i % n) + n) % n; }

/// The cubic of Catmull and Rom at a distance from its middle.
double cubic(double d) {
  d = std::abs(d);
  if (d >= 2) return 0;
  return d < 1 ? (1.5 * d - 2.5) * d * d + 1 : ((-0.5 * d + 2.5) * d - 4) * d + 2;
}

/// The picture `over` at whole pixels of its place; where it is larger, between texels.
Rgba read(const DoubleImage& over, const Place& place, glm::ivec2 at, bool tiles) {
  const auto texel = [&](int x, int y) {
    return tiles ? over.at(wrapped(x, over.width), wrapped(y, over.height)) : over.clamped(x, y);
  };
  const double x = source_position(at.x, over.width, place.size.x) - 0.5;
  const double y = source_position(at.y, over.height, place.size.y) - 0.5;
  const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
  Rgba sum(0), least = texel(left, top), most = least;
  for (int j = top - 1; j <= top + 2; ++j)
    for (int i = left - 1; i <= left + 2; ++i) {
      const Rgba one = texel(i, j);
      sum += one * (cubic(i - x) * cubic(j - y));
      least = glm::min(least, one);
      most = glm::max(most, one);
    }
  return glm::clamp(sum, least, most);
}

DoubleImage made_smaller(const DoubleImage& over, const Place& place) {
  const Size size{std::min(place.size.x, over.width), std::min(place.size.y, over.height)};
  return size == over.size() ? over : resized_to(over, size);
}

}  // namespace

DoubleImage covering(const DoubleImage& over, Size target) {
  const Place place = place_of(target, over.size(), {.fit = ImageOverlay::Fit::cover});
  const DoubleImage picture = made_smaller(over, place);
  return generate(target, [&](int x, int y) {
    return sample_linear(picture, source_position(x - place.corner.x, picture.width, place.size.x),
                         source_position(y - place.corner.y, picture.height, place.size.y));
  });
}

DoubleImage image_overlay(const DoubleImage& source, const DoubleImage& over, const ImageOverlay& s) {
  const Place place = place_of(source.size(), over.size(), s);
  const DoubleImage picture = made_smaller(over, place);
  const bool tiles = s.fit == ImageOverlay::Fit::tile;
  return generate(source.size(), [&](int x, int y) {
    const Rgba& below = source.at(x, y);
    glm::ivec2 at = glm::ivec2(x, y) - place.corner;
    if (tiles) at = {wrapped(at.x, place.size.x), wrapped(at.y, place.size.y)};
    if (at.x < 0 || at.y < 0 || at.x >= place.size.x || at.y >= place.size.y) return below;
    const Rgba above = read(picture, place, at, tiles);
    const Rgb light = Rgb(above) * s.intensity;
    if (s.blend == "normal") return Rgba(light + Rgb(below) * (1 - above.a), below.a);
    if (s.blend == "add") return Rgba(Rgb(below) + light, below.a);
    const Rgb made = blend(Rgb(below) / cover(below), light / cover(above), s.blend) * cover(below);
    return Rgba(glm::mix(Rgb(below), made, above.a), below.a);
  });
}

}  // namespace afterglow::reference
