// SPDX-License-Identifier: MIT
#include "reference/temporal.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace afterglow::reference {
namespace {

constexpr int kBins = 64;
constexpr double kFirst = -16, kLast = 16;  // EV
constexpr double kNear = 1.5;               // stops

double luminance(const Rgba& c) { return 0.2126729 * c.r + 0.7151522 * c.g + 0.0721750 * c.b; }
double brightest(const Rgba& c) { return std::max({c.r, c.g, c.b}); }

/// Of straight colour. Where nothing is drawn there is none.
double ev_of(const Rgba& c) { return c.a > 0 ? std::max(std::log2(luminance(c) / c.a / 0.18), kFirst) : 0; }

}  // namespace

double wanted_exposure(const DoubleImage& source, const AutoExposure& settings) {
  const int columns = std::min(source.width, 128), rows = std::min(source.height, 72);
  std::array<double, kBins> bins{}, sums{};  // weight, weight · EV
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int x0 = i * source.width / columns, x1 = (i + 1) * source.width / columns;
      const int y0 = j * source.height / rows, y1 = (j + 1) * source.height / rows;
      double sum = 0, count = 0;
      for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) {
          sum += source.at(x, y).a * ev_of(source.at(x, y));
          count += source.at(x, y).a;
        }
      if (count == 0) continue;
      const double u = (i + 0.5) / columns * 2 - 1, v = (j + 0.5) / rows * 2 - 1;
      const double weight = count * (settings.center ? std::exp(-2 * (u * u + v * v)) : 1);
      const double at = (std::clamp(sum / count, kFirst, kLast) - kFirst) * (kBins - 1) / (kLast - kFirst);
      const int low = std::min(static_cast<int>(at), kBins - 2);
      for (const int bin : {low, low + 1}) {
        const double share = weight * (1 - std::abs(bin - at));
        bins[static_cast<std::size_t>(bin)] += share;
        sums[static_cast<std::size_t>(bin)] += share * sum / count;
      }
    }
  double total = 0;
  for (const double bin : bins) total += bin;
  // The part of each bin that lies between the two percentiles of the cumulated histogram.
  const double from = total * settings.low_percentile / 100, to = total * settings.high_percentile / 100;
  double below = 0, sum = 0, count = 0;
  for (int i = 0; i < kBins; ++i) {
    const double above = below + bins[static_cast<std::size_t>(i)];
    const double counted = std::max(std::min(above, to) - std::max(below, from), 0.0);
    if (counted > 0) sum += counted * sums[static_cast<std::size_t>(i)] / bins[static_cast<std::size_t>(i)];
    count += counted;
    below = above;
  }
  return std::clamp(count > 0 ? sum / count : 0, settings.min_ev, settings.max_ev);
}

double adapted_exposure(double before, double wanted, double seconds, const AutoExposure& settings) {
  const double way = wanted - before, speed = way > 0 ? settings.speed_up : settings.speed_down;
  double off = std::abs(way);
  if (off > kNear) {
    const double even = std::min(seconds, (off - kNear) / speed);
    off -= even * speed;
    seconds -= even;
  }
  if (off <= kNear) off *= std::exp(-seconds * speed / kNear);
  return wanted - std::copysign(off, way);
}

DoubleImage auto_exposure(const DoubleImage& source, double exposure, const AutoExposure& settings) {
  const double factor = std::exp2(settings.compensation - exposure);
  return map_color(source, [&](const Rgb& c) { return c * factor; });
}

DoubleImage firefly_stabilisation(const DoubleImage& source, const std::vector<DoubleImage>& past,
                                  const FireflyStabilisation& settings) {
  const auto around = [&](int x, int y) {
    std::vector<double> ring;
    for (int dy = -2; dy <= 2; ++dy)
      for (int dx = -2; dx <= 2; ++dx)
        if (std::max(std::abs(dx), std::abs(dy)) == 2) ring.push_back(brightest(source.clamped(x + dx, y + dy)));
    std::sort(ring.begin(), ring.end());
    return ring[ring.size() - 2];
  };
  const auto before = [&](int x, int y) {
    double least = std::numeric_limits<double>::infinity();
    for (int frame = 0; frame < settings.frames; ++frame) {
      double most = 0;
      const auto known = static_cast<std::size_t>(frame) < past.size();
      const int reach = settings.search * (frame + 1);
      for (int dy = -reach; known && dy <= reach; ++dy)
        for (int dx = -reach; dx <= reach; ++dx)
          most = std::max(most, brightest(past[static_cast<std::size_t>(frame)].clamped(x + dx, y + dy)));
      if (!known && !settings.clamp_first) most = std::numeric_limits<double>::infinity();
      least = std::min(least, most);
    }
    return least;
  };
  return generate(source.size(), [&](int x, int y) {
    const Rgba& c = source.at(x, y);
    const double limit = std::max(settings.threshold, settings.tolerance * std::max(around(x, y), before(x, y)));
    return brightest(c) <= limit ? c : Rgba(Rgb(c) * (limit / brightest(c)), c.a);
  });
}

}  // namespace afterglow::reference
