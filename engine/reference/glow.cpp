// SPDX-License-Identifier: MIT
#include "reference/glow.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/gtc/constants.hpp>

#include "reference/resample.h"

namespace afterglow::reference {
namespace {

double sigma_of_level(std::size_t i) { return 0.76 * std::exp2(static_cast<double>(i)); }

/// The coarsest level still has four pixels each way.
std::size_t deepest_level(Size size) {
  std::size_t n = 1;
  while ((glm::min(size.width, size.height) >> (n + 1)) >= 4) ++n;
  return n;
}

std::vector<Rgb> normalised(std::vector<Rgb> weights) {
  Rgb sum(0);
  for (const auto& w : weights) sum += w;
  for (auto& w : weights) w /= sum;
  return weights;
}

const Filter& bspline_filter() {
  static const Filter filter{.interpolation = Interpolation::cubic_bspline};
  return filter;
}

DoubleImage with_light(const DoubleImage& source, const DoubleImage& light, const Rgb& tint) {
  return generate(source.size(), [&](int x, int y) {
    return Rgba(Rgb(source.at(x, y)) + tint * Rgb(light.at(x, y)), source.at(x, y).a);
  });
}

/// What is left of a pixel's weight at the picture's edge, over `fade` pixels around it.
double inside(double x, double y, Size size) {
  const double across = glm::clamp(glm::min(x, size.width - x) + 0.5, 0.0, 1.0);
  return across * glm::clamp(glm::min(y, size.height - y) + 0.5, 0.0, 1.0);
}

Rgb ray_lengths(double length, double dispersion) {
  return {length * (1 + 0.5 * dispersion), length, length * (1 - 0.4 * dispersion)};
}

struct Ghost {
  double place, light;
  Rgb coat;
};
const std::array<Ghost, 8> kGhosts{{{-0.45, 0.9, {0.45, 1.0, 0.7}},
                                    {-1.0, 0.35, {1.0, 0.62, 0.3}},
                                    {0.38, 0.7, {0.4, 0.6, 1.0}},
                                    {-1.7, 0.14, {0.85, 0.4, 1.0}},
                                    {0.7, 0.4, {1.0, 0.8, 0.45}},
                                    {-0.22, 1.0, {0.5, 0.85, 1.0}},
                                    {-2.6, 0.1, {0.55, 1.0, 0.55}},
                                    {1.6, 0.15, {1.0, 0.45, 0.4}}}};

/// Light at a point, as a share of the height from the middle; it fades within 8 % of the height at the edges.
double flare_light(const DoubleImage& image, double px, double py, int channel) {
  const double h = image.height, x = px * h + 0.5 * image.width, y = py * h + 0.5 * h;
  const auto fade = [&](double at, double size) {
    const double t = glm::clamp(glm::min(at, size - at) / (0.08 * h), 0.0, 1.0);
    return t * t * (3 - 2 * t);
  };
  const double shown = fade(x, image.width) * fade(y, h);
  return shown > 0 ? shown * sample_linear(image, x, y)[channel] : 0.0;
}

DoubleImage flare_ghosts(const DoubleImage& iris, const LensFlare& s) {
  return generate(iris.size(), [&](int x, int y) {
    const double h = iris.height, px = (x + 0.5 - 0.5 * iris.width) / h, py = (y + 0.5 - 0.5 * h) / h;
    const double away = std::hypot(px, py);
    Rgba sum(0, 0, 0, 1);
    for (int c = 0; c < 3; ++c) {
      for (int i = 0; i < s.count; ++i) {
        const Ghost& ghost = kGhosts[static_cast<std::size_t>(i)];
        const double m = ghost.place * s.spacing * (1 - 0.05 * s.dispersion * (c - 1));
        sum[c] += s.ghosts * ghost.light * ghost.coat[c] * flare_light(iris, px / m, py / m, c);
      }
      const double ring = s.halo_radius * (1 - 0.12 * s.dispersion * (c - 1));
      const double seen = glm::smoothstep(0.4, 0.8, away / ring);
      if (seen > 0) {
        const double r = ring / away;
        sum[c] += s.halo * seen * flare_light(iris, px - px * r, py - py * r, c);
      }
    }
    return sum;
  });
}

}  // namespace

DoubleImage glow_bright(const DoubleImage& image, double threshold, double limit) {
  return generate(image.size(), [&](int x, int y) {
    const Rgb c(image.at(x, y));
    const double b = glm::max(c.r, glm::max(c.g, c.b));
    return Rgba(c * (glm::max(0.0, glm::min(b, limit) - threshold) / glm::max(b, 1e-5)), 1);
  });
}

DoubleImage through_film(const DoubleImage& light, double own) {
  return generate(light.size(), [&](int x, int y) {
    const Rgb c(light.at(x, y));
    const double red = glm::max(c.r, 0.4 * luminance(c)), green = glm::min(c.g, red);
    return Rgba(glm::mix(Rgb(red, green, glm::min(c.b, green)), c, own), 1);
  });
}

std::vector<Rgb> exponential_weights(Size size, const Rgb& radii) {
  const double widest = glm::max(radii.r, glm::max(radii.g, radii.b));
  std::size_t n = 1;
  while (n < deepest_level(size) && sigma_of_level(n) < 3 * widest) ++n;
  std::vector<Rgb> weights;
  for (std::size_t i = 1; i <= n; ++i) {
    Rgb w;
    for (int c = 0; c < 3; ++c) {
      const double q = sigma_of_level(i) / glm::max(radii[c], 0.5);
      w[c] = q * q * q * std::exp(-0.5 * q * q);
    }
    weights.push_back(w);
  }
  return normalised(weights);
}

std::vector<Rgb> fog_weights(Size size, double extent) {
  std::vector<Rgb> weights;
  for (std::size_t i = 1; i <= deepest_level(size); ++i) {
    const double q = sigma_of_level(i) / glm::max(extent, 0.5), w = std::exp(-0.5 * q * q);
    if (i > 1 && w < 1e-3) break;
    weights.emplace_back(w);
  }
  return normalised(weights);
}

DoubleImage glow_half(const DoubleImage& source) { return resample(source, halved(source.size()), {}); }

DoubleImage glow_of(const DoubleImage& light, Size size, const std::vector<Rgb>& weights) {
  Filter tent;
  tent.x = tent.y = {{-1, 0.25}, {0, 0.5}, {1, 0.25}};
  std::vector<DoubleImage> levels{light};
  while (levels.size() < weights.size()) levels.push_back(resample(levels.back(), halved(levels.back().size()), tent));
  DoubleImage sum = map_color(levels.back(), [&](const Rgb& c) { return weights.back() * c; });
  for (std::size_t i = weights.size() - 1; i-- > 0;) {
    const DoubleImage up = resample(sum, levels[i].size(), bspline_filter());
    sum = with_light(up, levels[i], weights[i]);
  }
  return resample(sum, size, bspline_filter());
}

Size ray_size(Size size, int lines) {
  if (size.height <= 2 * lines) return halved(size);
  return {glm::max(static_cast<int>(std::int64_t{size.width} * lines / size.height), 1), lines};
}

DoubleImage rays_of(const DoubleImage& image, int count, double angle, const Rgb& length) {
  const double longest = glm::max(glm::max(length.r, length.g), glm::max(length.b, 1.0));
  const int reads = glm::clamp(static_cast<int>(std::ceil(std::pow(longest, 1.0 / 3))), 2, 16);
  Rgb fall;
  for (int c = 0; c < 3; ++c) fall[c] = std::log(100.0) / glm::max(length[c], 1.0);
  DoubleImage sum(image.size());
  for (int ray = 0; ray < count; ++ray) {
    const double turn = (angle + 360.0 * ray / count) * glm::pi<double>() / 180;
    double across = std::cos(turn), down = -std::sin(turn);
    if (std::abs(across) < 1e-9) across = 0;
    if (std::abs(down) < 1e-9) down = 0;
    DoubleImage ahead = image;
    double apart = 1;
    for (int stage = 0; stage < 3; ++stage, apart *= reads)
      ahead = generate(image.size(), [&](int x, int y) {
        Rgb light(0);
        for (int i = 0; i < reads; ++i) {
          const double px = x + 0.5 - i * apart * across, py = y + 0.5 - i * apart * down;
          const double shown = inside(px, py, image.size());
          if (shown <= 0) break;
          for (int c = 0; c < 3; ++c)
            light[c] += std::exp(-fall[c] * apart * i) * shown * sample_linear(ahead, px, py)[c];
        }
        return Rgba(light, 1);
      });
    for (std::size_t i = 0; i < sum.pixels.size(); ++i)
      for (int c = 0; c < 3; ++c) sum.pixels[i][c] += ahead.pixels[i][c] * (1 - std::exp(-fall[c])) / count;
  }
  return sum;
}

DoubleImage halation(const DoubleImage& source, const Halation& s) {
  const DoubleImage light = glow_half(through_film(glow_bright(source, s.threshold, s.clamp), s.source_color));
  const auto weights = exponential_weights(source.size(), s.radius * Rgb(1, 0.6, 0.4));
  return with_light(source, glow_of(light, source.size(), weights), s.intensity * s.color);
}

DoubleImage glare(const DoubleImage& source, const Glare& s) {
  if (s.kind == GlareKind::fog_glow) {
    const DoubleImage light = glow_half(glow_bright(source, s.threshold, s.clamp));
    const auto weights = fog_weights(source.size(), 0.5 * s.size * source.height);
    return with_light(source, glow_of(light, source.size(), weights), s.intensity * s.tint);
  }
  const DoubleImage light = resized_to(glow_bright(source, s.threshold, s.clamp), ray_size(source.size(), 540));
  const int count = s.kind == GlareKind::star ? s.points : 2;
  const DoubleImage rays = rays_of(light, count, s.angle, ray_lengths(s.size * light.height, s.dispersion));
  return with_light(source, resample(rays, source.size(), bspline_filter()), s.intensity * s.tint);
}

DoubleImage iris_blur(const DoubleImage& image, double radius, int blades, double rotation) {
  const int rings = glm::min(static_cast<int>(std::ceil(radius)), 16);
  const double sector = glm::two_pi<double>() / blades, turn = rotation * glm::pi<double>() / 180;
  return generate(image.size(), [&](int x, int y) {
    Rgb sum(image.at(x, y));
    for (int ring = 1; ring <= rings; ++ring)
      for (int i = 0; i < 6 * ring; ++i) {
        const double at = glm::two_pi<double>() * i / (6 * ring);
        const double side = std::cos(0.5 * sector) / std::cos(std::fmod(at, sector) - 0.5 * sector);
        const double far = radius * ring / rings * side;
        const double px = x + 0.5 + far * std::cos(at + turn), py = y + 0.5 - far * std::sin(at + turn);
        sum += inside(px, py, image.size()) * Rgb(sample_linear(image, px, py));
      }
    return Rgba(sum / (1.0 + 3 * rings * (rings + 1)), 1);
  });
}

DoubleImage lens_flare(const DoubleImage& source, const LensFlare& s) {
  const DoubleImage bright = resized_to(glow_bright(source, s.threshold, s.clamp), ray_size(source.size(), 270));
  DoubleImage sum(bright.size());
  if (s.ghosts > 0 || s.halo > 0) {
    const DoubleImage small = resized_to(bright, ray_size(source.size(), 135));
    const double radius = glm::max(s.iris * small.height, 0.5);
    sum = flare_ghosts(resample(iris_blur(small, radius, s.blades, s.rotation), bright.size(), bspline_filter()), s);
  }
  if (s.starburst > 0) {
    const int count = s.blades % 2 == 0 ? s.blades : 2 * s.blades;
    const Rgb length = ray_lengths(s.ray_length * bright.height, s.dispersion);
    sum = with_light(sum, rays_of(bright, count, s.rotation + 180.0 / s.blades, length), Rgb(s.starburst));
  }
  return with_light(source, resample(sum, source.size(), bspline_filter()), s.tint);
}

}  // namespace afterglow::reference
