// SPDX-License-Identifier: MIT
#include "reference/blurs.h"

#include <cmath>
#include <numbers>

#include "reference/resample.h"

namespace afterglow::reference {

namespace {

constexpr double kPi = std::numbers::pi;

Filter of_taps(std::vector<Tap2d> taps) { return {.interpolation = Interpolation::linear, .taps = std::move(taps)}; }

/// The mean along `length` columns of what is interpolated between columns that are `step` apart.
Filter mean_of_line(double length, glm::dvec2 step) {
  const double end = length / 2;
  if (end < 1e-6) return of_taps({{0, 0, 1}});
  const int last = static_cast<int>(std::ceil(end));
  std::vector<Tap2d> taps;
  for (int i = -last; i <= last; ++i) {
    double weight = 0;  // of a column between its neighbours: a straight line on each side
    for (const int side : {i - 1, i}) {
      const double from = glm::clamp<double>(side, -end, end), to = glm::clamp<double>(side + 1, -end, end);
      weight += (to - from) * (1 - std::abs((from + to) / 2 - i));
    }
    taps.push_back({i * step.x, i * step.y, weight / length});
  }
  return of_taps(std::move(taps));
}

/// The mean of `count` reads, `spacing` columns apart, interpolated along the line.
Filter pieces(int count, double spacing, glm::dvec2 step) {
  std::vector<Tap2d> taps;
  for (int i = -(count / 2); i <= count / 2; ++i) {
    const double low = std::floor(i * spacing), share = i * spacing - low;
    taps.push_back({low * step.x, low * step.y, (1 - share) / count});
    taps.push_back({(low + 1) * step.x, (low + 1) * step.y, share / count});
  }
  return of_taps(std::move(taps));
}

DoubleImage with_alpha_of(const DoubleImage& picture, DoubleImage image) {
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i].a = picture.pixels[i].a;
  return image;
}

}  // namespace

DoubleImage dual_kawase(const DoubleImage& source, int iterations, double offset_wanted) {
  const double offset = std::floor(offset_wanted * 1024 + 0.5) / 1024;
  std::vector<Tap2d> reads{{0, 0, 0.5}}, up;
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0}) {
      reads.push_back({x * offset, y * offset, 0.125});
      up.push_back({x * offset / 2, y * offset / 2, 2.0 / 12});
    }
  // Along an odd side each read is the mean of two, a texel apart.
  const auto down = [&](Size size) {
    std::vector<Tap2d> taps;
    for (const Tap2d& read : reads)
      for (const double x : {-0.25, 0.25})
        for (const double y : {-0.25, 0.25})
          taps.push_back({read.dx + 2 * x * (size.width % 2), read.dy + 2 * y * (size.height % 2), read.weight / 4});
    return taps;
  };
  for (const double d : {-offset, offset}) {
    up.push_back({d, 0, 1.0 / 12});
    up.push_back({0, d, 1.0 / 12});
  }
  DoubleImage image = source;
  std::vector<Size> sizes;
  for (int i = 0; i < iterations && image.width > 1 && image.height > 1; ++i) {
    sizes.push_back(image.size());
    image = resample(image, {image.width / 2, image.height / 2}, of_taps(down(image.size())));
  }
  for (auto size = sizes.rbegin(); size != sizes.rend(); ++size) image = resample(image, *size, of_taps(up));
  return with_alpha_of(source, image);
}

DoubleImage radial_blur(const DoubleImage& source, double intensity, int samples, Point center) {
  const double amount = glm::min(intensity, 63.0 / 64);
  const double across = glm::max(center.x, 1 - center.x) * source.width;
  const double down = glm::max(center.y, 1 - center.y) * source.height;
  const double length = std::hypot(across, down) * -std::log(1 - amount);

  const auto zoomed = [&](const DoubleImage& image, int count, double first, double step) {
    return generate(image.size(), [&](int x, int y) {
      const Point target(center.x * image.width, center.y * image.height), away = Point(x + 0.5, y + 0.5) - target;
      Rgb sum(0);
      double weights = 0;
      for (int i = 0; i < count; ++i) {
        const double weight = std::pow(step, i);
        const Point at = target + away * (first * weight);
        sum += weight * Rgb(sample_linear(image, at.x, at.y));
        weights += weight;
      }
      return Rgba(sum / weights, 1);
    });
  };
  const auto streaks = [&](int factor) {
    const int reads = glm::max(samples, static_cast<int>(std::ceil(length / (1.5 * factor))));
    const int near = static_cast<int>(std::ceil(std::sqrt(reads))), far = (reads + near - 1) / near;
    const double ratio = std::pow(1 - amount, 1.0 / (near * far));
    DoubleImage image = source;
    if (factor > 1) {
      Filter mean;
      const Size small{(source.width + factor - 1) / factor, (source.height + factor - 1) / factor};
      mean.x = mean_over(static_cast<double>(source.width) / small.width);
      mean.y = mean_over(static_cast<double>(source.height) / small.height);
      image = resample(image, small, mean);
    }
    image = zoomed(image, near, 1, ratio);
    image = zoomed(image, far, std::sqrt(ratio), std::pow(ratio, near));
    if (factor > 1) {
      const auto enlarge = factor > 2 ? Interpolation::cubic_bspline : Interpolation::linear;
      image = resample(image, source.size(), {.interpolation = enlarge});
    }
    return generate(source.size(), [&](int x, int y) {
      const Point away = Point(x + 0.5, y + 0.5) - center * Point(source.width, source.height);
      const double share = glm::clamp((amount * glm::length(away) / factor - 0.5) / 1.5, 0.0, 1.0);
      const Rgba& p = source.at(x, y);
      return Rgba(Rgb(p) + share * (Rgb(image.at(x, y)) - Rgb(p)), p.a);
    });
  };
  if (length <= 2) return streaks(1);
  const bool long_ones = length > 400;
  const double share = glm::min(long_ones ? (length - 400) / 200 : (length - 2) / 2, 1.0);
  const DoubleImage coarse = streaks(long_ones ? 4 : 2);
  if (share == 1) return coarse;
  const DoubleImage fine = streaks(long_ones ? 2 : 1);
  return generate(source.size(), [&](int x, int y) { return glm::mix(fine.at(x, y), coarse.at(x, y), share); });
}

DoubleImage directional_blur(const DoubleImage& source, double distance, double angle) {
  const double radians = angle * kPi / 180;
  const glm::dvec2 direction(std::cos(radians), -std::sin(radians));
  const double across = glm::max(std::abs(direction.x), std::abs(direction.y));
  const glm::dvec2 step = direction / across;
  const double length = glm::min(distance * across, 127.0 * 129.0);
  int n = 1;
  if (length > 35)
    while (n * (n + 2) < length) n += 2;
  const DoubleImage far = n == 1 ? source : resample(source, source.size(), pieces(n, length / n, step));
  return with_alpha_of(source, resample(far, source.size(), mean_of_line(length / n, step)));
}

}  // namespace afterglow::reference
