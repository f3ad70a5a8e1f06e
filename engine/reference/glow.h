// SPDX-License-Identifier: MIT
// Light that spreads in lenses and film: wide glows, halation, glare, lens flares (math.md §26–§28).
#pragma once

#include <string>
#include <vector>

#include "reference/double_image.h"

namespace afterglow::reference {

/// c · max(0, min(b, limit) − t)/max(b, 1e-5), b the largest channel.
DoubleImage glow_bright(const DoubleImage& image, double threshold, double limit);
/// What of light comes back through the layers of a film; `own` of it keeps its own colour.
DoubleImage through_film(const DoubleImage& light, double own);

/// Weights of the levels of a glow, by channel, that fall as e^(−r/radius); they sum up to 1. Pixels of `size`.
std::vector<Rgb> exponential_weights(Size size, const Rgb& radii);
/// Weights that fall with the square of the distance up to `extent` pixels.
std::vector<Rgb> fog_weights(Size size, double extent);
/// The picture at half its size, which is level 1 of a glow.
DoubleImage glow_half(const DoubleImage& source);
/// Σ weight · level, enlarged to `size`; `light` is level 1.
DoubleImage glow_of(const DoubleImage& light, Size size, const std::vector<Rgb>& weights);

/// Size of a picture for rays: so many lines; half of `size` where that has less than two for each.
Size ray_size(Size size, int lines);
/// `count` rays from each pixel; the first at `angle` degrees. `length`: where 1 % is left, pixels by channel.
DoubleImage rays_of(const DoubleImage& image, int count, double angle, const Rgb& length);

struct Halation {
  double intensity = 0.18, radius = 14, threshold = 1, clamp = 20;
  Rgb color{1, 0.28, 0.06};
  double source_color = 0;
};
DoubleImage halation(const DoubleImage& source, const Halation& settings);

enum class GlareKind { star, streaks, fog_glow };
struct Glare {
  GlareKind kind = GlareKind::star;
  double intensity = 0.18, threshold = 8, clamp = 200;
  int points = 6;
  double angle = 15, size = 0.25, dispersion = 0.4;
  Rgb tint{1};
};
DoubleImage glare(const DoubleImage& source, const Glare& settings);

struct LensFlare {
  double ghosts = 0.12, halo = 0.05, starburst = 0.15, threshold = 12, clamp = 150;
  int count = 7;
  double spacing = 1;
  int blades = 6;
  double rotation = 12, iris = 0.045, halo_radius = 0.42, ray_length = 0.22, dispersion = 0.5;
  Rgb tint{1};
};
/// The mean of a polygon around each pixel.
DoubleImage iris_blur(const DoubleImage& image, double radius, int blades, double rotation);
DoubleImage lens_flare(const DoubleImage& source, const LensFlare& settings);

}  // namespace afterglow::reference
