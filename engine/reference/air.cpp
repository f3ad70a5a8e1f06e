// SPDX-License-Identifier: MIT
#include "reference/air.h"

#include <cmath>
#include <functional>
#include <glm/gtc/constants.hpp>

#include "reference/glow.h"

namespace afterglow::reference {
namespace {

double radians_of(double degrees) { return degrees * glm::pi<double>() / 180; }

/// Mean of e^(−t) for t from 0 to u.
double mean_fall(double u) { return std::abs(u) < 1e-12 ? 1.0 : -std::expm1(-u) / u; }

double brightest_of(const Rgb& c) { return glm::max(glm::abs(c.r), glm::max(glm::abs(c.g), glm::abs(c.b))); }

/// At edges the mean of what the depths of a pixel and its neighbours give, by how alike their colours are.
double shared(const DoubleImage& source, const DoubleImage& depth, int x, int y,
              const std::function<double(double)>& hidden) {
  const Rgb here(source.at(x, y));
  double sum = 0, weights = 0, nearest = 1e15, farthest = 0;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const int ox = glm::clamp(x + dx, 0, source.width - 1), oy = glm::clamp(y + dy, 0, source.height - 1);
      const Rgb other(source.at(ox, oy));
      const Rgb apart = (other - here) / glm::max(glm::max(brightest_of(other), brightest_of(here)), 1e-6);
      const double weight = std::exp2(-6 * glm::dot(apart, apart));
      const double z = glm::clamp(depth.at(ox, oy).r, 0.0, 1e15);
      sum += weight * hidden(z);
      weights += weight;
      if (dx != 0 && dy != 0) continue;
      nearest = glm::min(nearest, z);
      farthest = glm::max(farthest, z);
    }
  const bool one_surface = farthest <= 1.05 * nearest || nearest >= 1e9;
  return one_surface ? hidden(glm::clamp(depth.at(x, y).r, 0.0, 1e15)) : sum / weights;
}

}  // namespace

DoubleImage depth_fog(const DoubleImage& source, const DoubleImage& depth, const DepthFog& s) {
  const bool spreads = s.scattering > 0 || s.ambient > 0;
  const DoubleImage around = spreads ? glow_of(glow_half(source), source.size(),
                                               fog_weights(source.size(), 0.5 * s.scattering_radius * source.height))
                                     : source;
  const double half = std::tan(radians_of(s.field_of_view) / 2);
  const double aspect = static_cast<double>(source.width) / source.height, pitch = radians_of(s.camera_pitch);
  const glm::dvec3 sun = glm::normalize(glm::dvec3((2 * s.sun_x - 1) * half * aspect, (1 - 2 * s.sun_y) * half, 1));
  const bool sunny = s.sun_color.r > 0 || s.sun_color.g > 0 || s.sun_color.b > 0;
  return generate(source.size(), [&](int x, int y) {
    const Rgba& p = source.at(x, y);
    const glm::dvec3 ray(((2 * x + 1.0) / source.width - 1) * half * aspect,
                         -((2 * y + 1.0) / source.height - 1) * half, 1);
    const double along = glm::length(ray), climb = (ray.y * std::cos(pitch) + std::sin(pitch)) / along;
    const double hidden = shared(source, depth, x, y, [&](double z) {
      const double clear = glm::min(s.start, z * along), through = z * along - clear;
      // Density at the height where the fog begins, then its mean along the rest of the ray.
      const double height = s.camera_height + climb * clear, thinner = s.height_falloff * climb * through;
      const double thick =
          s.density * std::exp(-s.height_falloff * height) * through * mean_fall(glm::clamp(thinner, -60.0, 1e30));
      return -std::expm1(-thick) * s.max_opacity * (z >= 1e9 ? s.sky : 1.0);
    });
    Rgb air = s.color;
    if (sunny) air = glm::mix(air, s.sun_color, std::pow(glm::max(glm::dot(ray / along, sun), 0.0), s.sun_focus));
    air = glm::mix(air * p.a, Rgb(around.at(x, y)), spreads ? s.ambient : 0.0);
    const Rgb seen = glm::mix(Rgb(p), Rgb(around.at(x, y)), spreads ? hidden * s.scattering : 0.0);
    return Rgba(glm::mix(seen, air, hidden), p.a);
  });
}

}  // namespace afterglow::reference
