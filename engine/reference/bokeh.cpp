// SPDX-License-Identifier: MIT
// math.md §36.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "reference/blurs.h"
#include "reference/color.h"
#include "reference/resample.h"

namespace afterglow::reference {

namespace {

double square(double x) { return x * x; }

/// How an iris that blurs as a round one from a radius on is read; `aside`: what all but the iris blurs, square pixels
/// an axis.
struct BokehWay {
  double from;
  int side, step;

  double spacing() const { return side * step; }
  double aside() const {
    if (side == 1) return step == 2 ? 0.5 : 0;
    // A tent over whole texels, and the way up: bilinear or B-spline.
    const double down = side % 2 == 0 ? square(side) / 6 + 1.0 / 12 : square(side) / 6 - 1.0 / 6;
    return down + square(side) / (side > 2 ? 3 : 6);
  }
  double softness() const { return aside() + square(spacing()) / 12; }
};

constexpr std::array<BokehWay, 14> kBokehWays{{{0, 1, 1},
                                               {3.3, 1, 2},
                                               {5, 2, 1},
                                               {11, 3, 1},
                                               {16, 4, 1},
                                               {28, 6, 1},
                                               {40, 8, 1},
                                               {56, 12, 1},
                                               {80, 16, 1},
                                               {112, 24, 1},
                                               {160, 32, 1},
                                               {224, 48, 1},
                                               {320, 64, 1},
                                               {448, 96, 1}}};

struct Aperture {
  int blades;
  double turn;

  /// Radius of the iris that has the point on its rim.
  double on_rim(double x, double y) const {
    const double distance = std::hypot(x, y);
    if (blades < 3) return distance;
    const double part = 2 * std::numbers::pi / blades, angle = std::atan2(y, x) - turn;
    return distance * std::cos(angle - part * (std::floor(angle / part) + 0.5)) / std::cos(part / 2);
  }

  /// Share of a square around the point that the iris covers.
  double share(double x, double y, double width, double radius) const {
    const double away = radius - on_rim(x, y);  // whole squares, for speed
    if (blades < 3 && std::abs(away) > width) return away > 0 ? 1 : 0;
    if (blades >= 3 && std::abs(away) > 2 * width) return away > 0 ? 1 : 0;
    double sum = 0;
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i) {
        const double rim = on_rim(x + (i - 1.5) * width / 4, y + (j - 1.5) * width / 4);
        sum += glm::clamp((radius - rim) / (width / 4) + 0.5, 0.0, 1.0) / 16;
      }
    return sum;
  }

  /// Mean square of a polygon's points to that of its outer circle's.
  double fullness() const { return blades < 3 ? 1 : (2 + std::cos(2 * std::numbers::pi / blades)) / 3; }
};

/// Every `step`th texel; lengths in texels.
std::vector<Tap2d> reads(const Aperture& iris, double radius, double rim, int step) {
  const int reach = static_cast<int>(std::ceil((radius + rim) / step));
  std::vector<Tap2d> taps;
  double sum = 0;
  for (int j = -reach; j <= reach; ++j)
    for (int i = -reach; i <= reach; ++i) {
      const double weight = iris.share(i * step, j * step, rim, radius);
      if (weight > 0) taps.push_back({static_cast<double>(i * step), static_cast<double>(j * step), weight});
      sum += weight;
    }
  if (sum == 0) return {{0, 0, 1}};
  for (auto& tap : taps) tap.weight /= sum;
  return taps;
}

/// The reads whose mean square, with what else blurs, is that of the iris of `radius` pixels; `soft`: all that is not
/// the iris. By halves, as slow as it is sure.
std::vector<Tap2d> compensated(const Aperture& iris, double radius, const BokehWay& way, double soft) {
  const double rim = std::sqrt(12 * (soft - way.aside())) / way.side;
  const double wanted = iris.fullness() * square(radius) / 4 - way.aside();
  std::vector<Tap2d> taps;
  const auto makes_enough = [&](double wide) {
    taps = reads(iris, wide / way.side, rim, way.step);
    double made = 0;
    for (const auto& tap : taps) made += tap.weight * (square(tap.dx) + square(tap.dy)) / 2 * square(way.side);
    return made >= wanted;
  };
  double low = radius / 2, high = 2 * radius + way.spacing();
  if (makes_enough(low)) return taps;
  for (int i = 0; i < 50; ++i) {
    const double middle = (low + high) / 2;
    (makes_enough(middle) ? high : low) = middle;
  }
  return taps;
}

/// A tent of `side` texels each way, at texels.
std::vector<Tap> bokeh_tent(int side) {
  std::vector<Tap> taps;
  for (double at = side % 2 == 1 ? 1 - side : 0.5 - side; at < side; ++at)
    taps.push_back({at, (1 - std::abs(at) / side) / side});
  return taps;
}

}  // namespace

DoubleImage bokeh_blur(const DoubleImage& source, const BokehBlur& s) {
  const double radius = glm::min(s.radius, 672.0);
  DoubleImage image = source;
  for (auto& p : image.pixels) {
    const double y = glm::min(luminance(Rgb(p)), 1.0), weight = 1 + s.highlights * y * y;
    p = Rgba(Rgb(p) * weight, weight);
  }
  const Aperture iris{s.blades, s.rotation * std::numbers::pi / 180};
  const double as_round = radius * std::sqrt(iris.fullness());
  const auto next =
      std::find_if(kBokehWays.begin(), kBokehWays.end(), [&](const BokehWay& way) { return way.from > as_round; });
  const BokehWay way = *(next - 1);
  double soft = way.softness();
  if (next != kBokehWays.end()) {
    const double part = (square(as_round) - square(way.from)) / (square(next->from) - square(way.from));
    soft += square(part) * (next->softness() - soft);
  }
  if (way.side > 1) {
    const Size small{(source.width + way.side - 1) / way.side, (source.height + way.side - 1) / way.side};
    image = resample(image, small, {.x = bokeh_tent(way.side), .y = bokeh_tent(way.side)});
  }
  image = resample(image, image.size(), {.taps = compensated(iris, radius, way, soft)});
  if (way.step == 2)
    image = resample(image, image.size(), {.taps = {{-.5, -.5, .25}, {.5, -.5, .25}, {-.5, .5, .25}, {.5, .5, .25}}});
  if (way.side > 1)
    image = resample(image, source.size(),
                     {.interpolation = way.side > 2 ? Interpolation::cubic_bspline : Interpolation::linear});
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = Rgba(Rgb(image.pixels[i]) / image.pixels[i].a, source.pixels[i].a);
  return image;
}

}  // namespace afterglow::reference
