// SPDX-License-Identifier: MIT
#include "reference/blurs.h"

#include <cmath>
#include <numbers>

#include "reference/color.h"
#include "reference/resample.h"

namespace afterglow::reference {

namespace {

constexpr double kPi = std::numbers::pi;

Filter of_taps(std::vector<Tap2d> taps) { return {.interpolation = Interpolation::linear, .taps = std::move(taps)}; }

/// `count` reads on a line, `spacing` apart.
Filter line(int count, double spacing, double angle) {
  std::vector<Tap2d> taps;
  for (int i = 0; i < count; ++i) {
    const double at = (i - (count - 1) / 2.0) * spacing;
    taps.push_back({at * std::cos(angle), -at * std::sin(angle), 1.0 / count});
  }
  return of_taps(std::move(taps));
}

/// 6k points on ring k of a circle or polygon of radius 1; the centre's disc has three quarters of a point's area.
Filter rings(int count, double spacing, int blades, double turn) {
  std::vector<Tap2d> taps{{0, 0, 0.75}};
  for (int ring = 1; ring <= count; ++ring)
    for (int i = 0; i < 6 * ring; ++i) {
      const double angle = 2 * kPi * i / (6 * ring);
      double r = ring * spacing;
      if (blades >= 3) {
        const double side = 2 * kPi / blades;
        r *= std::cos(side / 2) / std::cos(std::fmod(angle, side) - side / 2);
      }
      taps.push_back({r * std::cos(angle + turn), r * std::sin(angle + turn), 1});
    }
  double sum = 0;
  for (const auto& tap : taps) sum += tap.weight;
  for (auto& tap : taps) tap.weight /= sum;
  return of_taps(std::move(taps));
}

DoubleImage with_alpha_of(const DoubleImage& picture, DoubleImage image) {
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i].a = picture.pixels[i].a;
  return image;
}

}  // namespace

DoubleImage dual_kawase(const DoubleImage& source, int iterations, double offset_wanted) {
  const double offset = std::floor(offset_wanted * 1024 + 0.5) / 1024;
  std::vector<Tap2d> down{{0, 0, 0.5}}, up;
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0}) {
      down.push_back({x * offset, y * offset, 0.125});
      up.push_back({x * offset / 2, y * offset / 2, 2.0 / 12});
    }
  for (const double d : {-offset, offset}) {
    up.push_back({d, 0, 1.0 / 12});
    up.push_back({0, d, 1.0 / 12});
  }
  DoubleImage image = source;
  std::vector<Size> sizes;
  for (int i = 0; i < iterations && image.width > 1 && image.height > 1; ++i) {
    sizes.push_back(image.size());
    image = resample(image, {image.width / 2, image.height / 2}, of_taps(down));
  }
  for (auto size = sizes.rbegin(); size != sizes.rend(); ++size) image = resample(image, *size, of_taps(up));
  return with_alpha_of(source, image);
}

DoubleImage radial_blur(const DoubleImage& source, double intensity, int samples, Point center) {
  return generate(source.size(), [&](int x, int y) {
    const Point here(x + 0.5, y + 0.5), target(center.x * source.width, center.y * source.height);
    Rgb sum(0);
    for (int i = 0; i < samples; ++i) {
      const Point at = here + (target - here) * (intensity * i / (samples - 1));
      sum += Rgb(sample_linear(source, at.x, at.y));
    }
    return Rgba(sum / static_cast<double>(samples), source.at(x, y).a);
  });
}

DoubleImage directional_blur(const DoubleImage& source, double distance, double angle) {
  const double radians = angle * kPi / 180;
  const int reads = glm::max(2, static_cast<int>(std::ceil(distance)));
  const int root = static_cast<int>(std::ceil(std::sqrt(reads)));
  int n = root, m = root;
  for (int near = root; near <= 2 * root; ++near) {
    const int far = (reads + near - 1) / near;
    if (far + near <= 2 * root && far * near < n * m) n = far, m = near;
  }
  const double spacing = distance / (n * m);
  const DoubleImage far = resample(source, source.size(), line(n, m * spacing, radians));
  return with_alpha_of(source, resample(far, source.size(), line(m, spacing, radians)));
}

DoubleImage bokeh_blur(const DoubleImage& source, const BokehBlur& s) {
  DoubleImage weighed = source;
  for (auto& p : weighed.pixels) {
    const double y = glm::min(luminance(Rgb(p)), 1.0), weight = 1 + s.highlights * y * y;
    p = Rgba(Rgb(p) * weight, weight);
  }
  const double spacing = s.radius / 4.5;
  DoubleImage image = resample(weighed, source.size(), rings(4, spacing, s.blades, s.rotation * kPi / 180));
  image = resample(image, source.size(), rings(1, spacing / 2, 0, 0));
  for (auto& p : image.pixels) p = Rgba(Rgb(p) / p.a, 1);
  return with_alpha_of(source, image);
}

DoubleImage circles_of_confusion(const DoubleImage& depth, const DepthOfField& s) {
  const double f = s.focal_length * 1e-3, d = glm::max(s.focus_distance, 1.01 * f);
  const double aperture = f / s.aperture, pixels_per_metre = depth.height / (s.sensor_height * 1e-3);
  return generate(depth.size(), [&](int x, int y) {
    const double z = depth.at(x, y).r;
    const double diameter = aperture * f * (z - d) / (z * (d - f));
    return Rgba(glm::clamp(diameter / 2 * pixels_per_metre, -s.max_radius, s.max_radius));
  });
}

namespace {

/// The widest circle of the tiles around each tile of `side` pixels.
DoubleImage widest_around(const DoubleImage& circles, int side) {
  DoubleImage tiles((circles.width + side - 1) / side, (circles.height + side - 1) / side, Rgba(0));
  for (int y = 0; y < circles.height; ++y)
    for (int x = 0; x < circles.width; ++x) {
      double& widest = tiles.at(x / side, y / side).r;
      widest = glm::max(widest, std::abs(circles.at(x, y).r));
    }
  return generate(tiles.size(), [&](int x, int y) {
    double widest = 0;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) widest = glm::max(widest, tiles.clamped(x + dx, y + dy).r);
    return Rgba(widest);
  });
}

}  // namespace

DoubleImage depth_of_field(const DoubleImage& source, const DoubleImage& depth, const DepthOfField& s) {
  const DoubleImage circles = circles_of_confusion(depth, s);
  const int side = static_cast<int>(std::ceil(s.max_radius));
  const DoubleImage around = widest_around(circles, side);
  const double golden_angle = kPi * (3 - std::sqrt(5.0));
  return generate(source.size(), [&](int x, int y) {
    const double own = circles.at(x, y).r, widest = around.at(x / side, y / side).r;
    if (widest < 0.5) return source.at(x, y);
    const double limit = glm::min(widest + 0.5, s.max_radius);
    double weight = 0.5 / s.samples;
    Rgb sum = weight * Rgb(source.at(x, y));
    for (int i = 0; i < s.samples; ++i) {
      const double t = (i + 0.5) / s.samples, radius = t * limit, angle = -golden_angle * (i + 1);
      const int px = x + static_cast<int>(std::floor(std::cos(angle) * radius + 0.5));
      const int py = y + static_cast<int>(std::floor(std::sin(angle) * radius + 0.5));
      const double circle = circles.clamped(px, py).r;
      const double reach = circle > own ? glm::min(std::abs(circle), 2 * std::abs(own)) : std::abs(circle);
      const double in = glm::clamp(reach - radius + 0.5, 0.0, 1.0), covered = in * in * (3 - 2 * in);
      const Rgb mean = sum / weight;
      sum += t * (mean + covered * (Rgb(source.clamped(px, py)) - mean));
      weight += t;
    }
    return Rgba(sum / weight, source.at(x, y).a);
  });
}

}  // namespace afterglow::reference
