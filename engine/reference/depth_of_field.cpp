// SPDX-License-Identifier: MIT
#include "reference/depth_of_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "reference/color.h"
#include "reference/edge_pixels.h"
#include "reference/lens.h"

namespace afterglow::reference {
namespace {

constexpr double kPi = std::numbers::pi;

/// How blurred a circle is for the eye, 0…1; `factor` is the side of a small picture's pixel.
double blurred_by(double radius, int factor) {
  return glm::clamp((std::abs(radius) - 0.5) / (1.15 * factor - 0.5), 0.0, 1.0);
}

double widest_of(const std::vector<Rgba>& pixels) {
  double widest = 0;
  for (const Rgba& p : pixels)
    if (std::abs(p.a) > std::abs(widest) || (std::abs(p.a) == std::abs(widest) && p.a < 0)) widest = p.a;
  return widest;
}

double likeness(const Rgba& pixel, double widest, double least) {
  return glm::clamp(1.5 - 2 * std::abs(pixel.a - widest) / glm::max(std::abs(widest), least), 0.0, 1.0);
}

/// The light of those whose circles are like the widest, and that circle, over `scale`. A circle counts as at least
/// `least` wide.
Rgba like_the_widest(const std::vector<Rgba>& pixels, double least, double scale) {
  const double widest = widest_of(pixels);
  Rgb sum(0);
  double weights = 0;
  for (const Rgba& p : pixels) {
    const double weight = likeness(p, widest, least);
    sum += weight * Rgb(p);
    weights += weight;
  }
  return Rgba(sum / weights, widest / scale);
}

/// The iris as a convex shape: how large it must be for a point to lie on its rim.
struct Iris {
  const DepthOfField& s;
  Point stretch() const { return {glm::max(1.0, s.squeeze), glm::max(1.0, 1 / s.squeeze)}; }
  double soft() const { return 2 * glm::max(s.squeeze, 1 / s.squeeze); }
  double hidden(int x, int y, Size size) const {
    return s.cat_eye * glm::length(from_centre(x, y, size)) / std::hypot(size.width / 2.0, size.height / 2.0);
  }
  static Point from_centre(int x, int y, Size size) {
    return {x + 0.5 - size.width / 2.0, y + 0.5 - size.height / 2.0};
  }

  double radius_of(Point point, int x, int y, Size size) const {
    point *= stretch();
    double radius = glm::length(point);
    if (s.blades >= 3) {
      radius = 0;
      for (int i = 0; i < s.blades; ++i) {
        const double angle = s.rotation * kPi / 180 + 2 * kPi * (i + 0.5) / s.blades;
        const double side = point.x * std::cos(angle) + point.y * std::sin(angle);
        radius = glm::max(radius, side / std::cos(kPi / s.blades));
      }
    }
    if (s.cat_eye > 0) {
      // Both of two circles, `apart` radii apart, have to hold it: the larger root of a quadratic equation.
      const double apart = hidden(x, y, size);
      const Point out = from_centre(x, y, size), along = out / glm::max(glm::length(out), 1e-3);
      const double across = std::abs(glm::dot(point, along)) * apart, a = 1 - apart * apart / 4;
      radius = glm::max(radius, (across + std::sqrt(across * across + 4 * a * glm::dot(point, point))) / (2 * a));
    }
    return radius;
  }

  /// Its area, in that of a disc.
  double part(int x, int y, Size size) const {
    double area = 1 / glm::max(s.squeeze, 1 / s.squeeze);
    if (s.blades >= 3) area *= s.blades * std::sin(2 * kPi / s.blades) / (2 * kPi);
    if (s.cat_eye > 0) {
      const double t = hidden(x, y, size) / 2;
      area *= 1 - 2 / kPi * (std::asin(t) + t * std::sqrt(1 - t * t));
    }
    return area;
  }

  double disc(double radius, double away) const { return glm::clamp((radius - away) / soft() + 0.5, 0.0, 1.0); }
  double area(double radius) const { return kPi * (radius * radius + soft() * soft() / 12); }
};

int level_for(double radius, double samples) {
  const double texels = kPi / 4 * radius * radius;
  return texels > 4 * samples ? 2 : texels > samples ? 1 : 0;
}

double before_means(double radius) { return std::sqrt(glm::max(radius * radius - 4.0 / 3, 0.0)); }

struct Pyramid {
  std::vector<DoubleImage> levels;
  std::vector<DoubleImage> middles;  ///< where in its texel the light lies, from the centre (r, g)

  /// `finest`: in place of each texel, the pixel of the finest level in its middle.
  /// f(texel, offset of its light from the pixel's centre) for the texels of a level that pixel (x, y) reads: every
  /// second row and column, others than its neighbours.
  template <class F>
  void visit(int x, int y, int level, double reach, F&& f, bool finest = false) const {
    const DoubleImage& image = levels[static_cast<std::size_t>(level)];
    const int texel = 1 << level, far = static_cast<int>(std::ceil(reach)) + texel;
    for (int v = (y - far) >> level; v <= (y + far) >> level; ++v)
      for (int u = (x - far) >> level; u <= (x + far) >> level; ++u)
        if (((u - y) & 1) == 0 && ((v - x - y) & 1) == 0) {
          const Point centre((u + 0.5) * texel - x - 0.5, (v + 0.5) * texel - y - 0.5);
          const Rgba& middle = middles[static_cast<std::size_t>(level)].clamped(u, v);
          if (finest) {
            f(levels[0].clamped(u * texel + texel / 2, v * texel + texel / 2), centre);
          } else {
            f(image.clamped(u, v), centre + Point(middle.r, middle.g));
          }
        }
  }
};

Pyramid pyramid_of(const DoubleImage& source, const DoubleImage& circles, int factor) {
  Pyramid pyramid;
  const Size small{(source.width + factor - 1) / factor, (source.height + factor - 1) / factor};
  pyramid.levels.push_back(generate(small, [&](int x, int y) {
    std::vector<Rgba> pixels;
    for (int j = y * factor; j < (y + 1) * factor; ++j)
      for (int i = x * factor; i < (x + 1) * factor; ++i)
        pixels.emplace_back(Rgb(source.clamped(i, j)), circles.clamped(i, j).r);
    return like_the_widest(pixels, 1, factor);
  }));
  pyramid.middles.emplace_back(small, Rgba(0));
  for (int level = 1; level < 3; ++level) {
    const DoubleImage finer = pyramid.levels.back(), middles = pyramid.middles.back();
    const auto four_of = [&](const DoubleImage& image, int x, int y) {
      std::vector<Rgba> four;
      for (int i = 0; i < 4; ++i) four.push_back(image.clamped(2 * x + i % 2, 2 * y + i / 2));
      return four;
    };
    const Size size{(finer.width + 1) / 2, (finer.height + 1) / 2};
    pyramid.levels.push_back(
        generate(size, [&](int x, int y) { return like_the_widest(four_of(finer, x, y), 0.5, 1); }));
    pyramid.middles.push_back(generate(size, [&](int x, int y) {
      const auto four = four_of(finer, x, y), inner = four_of(middles, x, y);
      const double widest = widest_of(four), apart = level == 1 ? 0.5 : 1;
      Point sum(0);
      double lights = 0;
      for (std::size_t i = 0; i < 4; ++i) {
        const double light = (glm::max(luminance(Rgb(four[i])), 0.0) + 1e-6) * likeness(four[i], widest, 0.5);
        sum += light * (Point(inner[i].r, inner[i].g) + apart * Point(i % 2 == 0 ? -1 : 1, i < 2 ? -1 : 1));
        lights += light;
      }
      return Rgba(sum / lights, 0, 0);
    }));
  }
  return pyramid;
}

DoubleImage far_field(const Pyramid& pyramid, const Iris& iris, int factor) {
  const DoubleImage& small = pyramid.levels[0];
  return generate(small.size(), [&](int x, int y) {
    const Rgba own = small.at(x, y);
    const bool hidden = own.a < 0;
    const double circle = std::abs(own.a), blur = blurred_by(circle * factor, factor),
                 weight = glm::max(blur, 1.0 / 4096);
    const int level = level_for(circle, hidden ? 0.25 * iris.s.samples : iris.s.samples);
    const double radius = glm::max(before_means(circle), hidden ? 1.0 : 0.0);
    if (radius <= 0) return Rgba(Rgb(own), 1) * weight;
    Rgba sum(0);
    pyramid.visit(
        x, y, level, radius + iris.soft() / 2,
        [&](const Rgba& read, Point offset) {
          const double held = hidden ? radius : glm::clamp(read.a / circle, 0.0, 1.0) * radius;
          const double counts = hidden ? glm::clamp(2 * read.a / circle + 1.5, 0.0, 1.0)
                                       : blurred_by(glm::max(read.a, 0.0) * factor, factor) *
                                             glm::min(iris.area(radius) / iris.area(held), 4.0);
          sum += counts * iris.disc(held, iris.radius_of(offset, x, y, small.size())) * Rgba(Rgb(read), 1);
        },
        hidden);
    return sum * (static_cast<double>(4 << (2 * level)) / iris.area(radius) * weight) +
           glm::max((1 - blur) / 4096, 1e-5) * Rgba(Rgb(own), 1);
  });
}

/// The widest circle in front of the focus in the tiles around each tile of `side` pixels.
DoubleImage widest_in_front(const DoubleImage& small, int side) {
  DoubleImage tiles((small.width + side - 1) / side, (small.height + side - 1) / side, Rgba(0));
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x) {
      double& widest = tiles.at(x / side, y / side).r;
      widest = glm::max(widest, -small.at(x, y).a);
    }
  return generate(tiles.size(), [&](int x, int y) {
    double widest = 0;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) widest = glm::max(widest, tiles.clamped(x + dx, y + dy).r);
    return Rgba(widest);
  });
}

DoubleImage near_field(const Pyramid& pyramid, const Iris& iris, int factor) {
  const DoubleImage& small = pyramid.levels[0];
  const int side = glm::max(8, static_cast<int>(std::ceil(iris.s.max_radius / factor)) + 2);
  const DoubleImage tiles = widest_in_front(small, side);
  return generate(small.size(), [&](int x, int y) {
    const double around = tiles.at(x / side, y / side).r;
    if (blurred_by(around * factor, factor) <= 0) return Rgba(0);
    const int coarsest = level_for(around, iris.s.samples);
    const double split = 2 << coarsest;  // below it the finest level is read, and of half of it nothing else
    Rgba sum(0);
    const auto add = [&](int level, double upto, auto&& share) {
      const double shrink = before_means(around) / around;
      pyramid.visit(x, y, level, upto * shrink + iris.soft() / 2, [&](const Rgba& read, Point offset) {
        const double circle = glm::max(-read.a, 0.0), radius = glm::max(circle * shrink, iris.soft() / 2);
        const double counts = iris.disc(radius, iris.radius_of(offset, x, y, small.size())) *
                              blurred_by(circle * factor, factor) * share(circle) / iris.area(radius);
        sum += counts * static_cast<double>(4 << (2 * level)) * Rgba(Rgb(read), 1);
      });
    };
    if (coarsest == 0) {
      add(0, around, [](double) { return 1.0; });
    } else {
      add(coarsest, around, [&](double circle) { return glm::clamp(2 * circle / split - 1, 0.0, 1.0); });
      add(0, split, [&](double circle) { return glm::clamp(2 - 2 * circle / split, 0.0, 1.0); });
    }
    return sum / iris.part(x, y, small.size());
  });
}

/// The mean of 2×2 pixels at each corner between them, read at the point of the small picture where (x, y) lies.
Rgba at_corners(const DoubleImage& small, int x, int y, int factor) {
  const double px = (x + 0.5) / factor - 1, py = (y + 0.5) / factor - 1;
  const int left = static_cast<int>(std::floor(px)), top = static_cast<int>(std::floor(py));
  const auto corner = [&](int u, int v) {
    u = glm::clamp(u, 0, small.width - 1), v = glm::clamp(v, 0, small.height - 1);
    return (small.clamped(u, v) + small.clamped(u + 1, v) + small.clamped(u, v + 1) + small.clamped(u + 1, v + 1)) /
           4.0;
  };
  const double fx = px - left, fy = py - top;
  return (corner(left, top) * (1 - fx) + corner(left + 1, top) * fx) * (1 - fy) +
         (corner(left, top + 1) * (1 - fx) + corner(left + 1, top + 1) * fx) * fy;
}

/// What stands for a pixel that holds light of what is blurred in front of it: its neighbours away from the edge, if
/// their circles are like its own.
Rgb behind_edge(const DoubleImage& source, const DoubleImage& circles, int x, int y) {
  const double circle = circles.at(x, y).r;
  const auto before = [&](int dx, int dy) {
    const double there = circles.clamped(x + dx, y + dy).r;
    return glm::clamp(glm::min(-there, circle - there) - 0.5, 0.0, 1.0);
  };
  const auto like = [&](int dx, int dy) {
    const double other = circles.clamped(x + dx, y + dy).r - circle;
    return 1 / (1 + other * other);
  };
  return mean_behind_edge(source, x, y, before, like);
}

}  // namespace

double autofocus(const DoubleImage& depth, const FocusPoint& point) {
  constexpr int kPoints = 8;
  std::vector<double> dioptres;
  for (int j = 0; j < kPoints; ++j)
    for (int i = 0; i < kPoints; ++i) {
      const auto place = [&](double middle, int side, int index) {
        const double at = middle * side + ((index + 0.5) / kPoints - 0.5) * point.area * depth.height;
        return glm::clamp(static_cast<int>(std::floor(at)), 0, side - 1);
      };
      const double z = depth.at(place(point.x, depth.width, i), place(point.y, depth.height, j)).r;
      dioptres.push_back(1 / std::max(z, 1e-4));
    }
  std::ranges::sort(dioptres);
  return 1 / dioptres[dioptres.size() / 2];
}

double follow_focus(double before, double wanted, double speed, double seconds) {
  return 1 / (1 / wanted + (1 / before - 1 / wanted) * std::exp(-speed * seconds));
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

DoubleImage depth_of_field(const DoubleImage& source, const DoubleImage& depth, const DepthOfField& s) {
  const DoubleImage circles = circles_of_confusion(depth, s);
  const bool is_small = std::max(source.width, source.height) <= 1024 && source.width * source.height <= 1 << 18;
  const int least = is_small ? 1 : 2;
  const int factor = glm::max(least, static_cast<int>(std::ceil(s.max_radius / 32)));
  const Pyramid pyramid = pyramid_of(source, circles, factor);
  const Iris iris{s};
  const DoubleImage far = far_field(pyramid, iris, factor), near = near_field(pyramid, iris, factor);
  return generate(source.size(), [&](int x, int y) {
    const Rgba color = source.at(x, y), behind = at_corners(far, x, y, factor), front = at_corners(near, x, y, factor);
    const double circle = circles.at(x, y).r, blur = blurred_by(circle, factor);
    const Rgb sharp = front.a > 0 ? behind_edge(source, circles, x, y) : Rgb(color);
    const Rgb base = sharp * (1 - blur) + Rgb(behind) / behind.a * blur;
    const double seen = circle < 0 ? 1 + blur * (glm::min(16 * behind.a, 1.0) - 1) : 1;
    const double rest = glm::max(1 - front.a, 0.0) * seen;
    return Rgba((base * rest + Rgb(front)) / (front.a + rest), color.a);
  });
}

}  // namespace afterglow::reference
