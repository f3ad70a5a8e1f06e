// SPDX-License-Identifier: MIT
#include "bench/stability.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace afterglow::bench {
namespace {

constexpr int kPoints = 64;  ///< per axis, for the mean over a pixel's area
constexpr float kGround = 0.05f;

double luminance(const float* rgb) { return 0.2126729 * rgb[0] + 0.7151522 * rgb[1] + 0.0721750 * rgb[2]; }

Picture empty_picture(Size size) {
  Picture picture;
  picture.color = Image(size.width, size.height, 4);
  picture.data_window = picture.display_window = {0, 0, size.width, size.height};
  return picture;
}

/// The share of the pixel from (x, y) on that a disc around (0, 0) covers.
float covered(double x, double y, double radius) {
  constexpr double kHalfDiagonal = 0.7072;
  const double distance = std::hypot(x + 0.5, y + 0.5);
  if (distance > radius + kHalfDiagonal) return 0;
  if (distance < radius - kHalfDiagonal) return 1;
  int inside = 0;
  for (int i = 0; i < kPoints * kPoints; ++i) {
    const double u = x + (i % kPoints + 0.5) / kPoints, v = y + (i / kPoints + 0.5) / kPoints;
    inside += u * u + v * v < radius * radius;
  }
  return static_cast<float>(inside) / (kPoints * kPoints);
}

/// Mixes `light` into each pixel by the share of its area that the disc covers.
void add_disc(Image& image, double cx, double cy, double radius, std::array<float, 3> light) {
  const auto from = [](double v) { return static_cast<int>(std::floor(v)); };
  for (int y = std::max(from(cy - radius), 0); y <= std::min(from(cy + radius), image.height - 1); ++y)
    for (int x = std::max(from(cx - radius), 0); x <= std::min(from(cx + radius), image.width - 1); ++x) {
      const float share = covered(x - cx, y - cy, radius);
      for (std::size_t c = 0; c < 3; ++c) image.at(x, y)[c] += share * (light[c] - image.at(x, y)[c]);
    }
}

void fill_ground(Image& image) {
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = i % 4 == 3 ? 1.0f : kGround;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  return values[values.size() / 2];
}

Result<std::unique_ptr<Session>> open(const std::filesystem::path& preset, SessionOptions options,
                                      const Variant& variant, Diagnostics& diagnostics) {
  options.stack.choice = variant.choice;
  options.stack.preset.overrides.insert(options.stack.preset.overrides.end(), variant.overrides.begin(),
                                        variant.overrides.end());
  return Session::open(preset, options, diagnostics);
}

/// What a frame's look added, by pixel, as luminance.
Result<std::vector<double>> added_light(Session& session, const Picture& source, int frame) {
  Picture picture = source;
  const BuildContext context{.frame = static_cast<double>(frame), .time = frame / 24.0, .fps = 24.0};
  AFTERGLOW_CHECK(session.process(picture, context));
  std::vector<double> out(source.color.pixels.size() / 4);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = luminance(&picture.color.pixels[4 * i]) - luminance(&source.color.pixels[4 * i]);
  return out;
}

/// Pixels that are the same in every frame; all of them where hardly any are.
std::vector<bool> still_pixels(const std::vector<Picture>& frames) {
  std::vector<bool> still(frames.front().color.pixels.size() / 4, true);
  for (const auto& frame : frames)
    for (std::size_t i = 0; i < still.size(); ++i)
      still[i] = still[i] && std::equal(&frame.color.pixels[4 * i], &frame.color.pixels[4 * i] + 3,
                                        &frames.front().color.pixels[4 * i]);
  const auto count = static_cast<std::size_t>(std::ranges::count(still, true));
  if (count < still.size() / 100) still.assign(still.size(), true);
  return still;
}

/// The share of target pixel `i` (of `n` on an axis) that lies in each source pixel (of `from`): first index, weights.
std::pair<int, std::vector<double>> area_weights(int i, int from, int n) {
  const double ratio = static_cast<double>(from) / n, begin = i * ratio, end = (i + 1) * ratio;
  const int first = static_cast<int>(begin);
  std::vector<double> weights;
  for (int at = first; at < from && at < end; ++at)
    weights.push_back((std::min(end, at + 1.0) - std::max(begin, static_cast<double>(at))) / ratio);
  return {first, weights};
}

std::vector<double> averaged(const std::vector<double>& light, Size from, Size to) {
  std::vector<double> out(static_cast<std::size_t>(to.area()));
  for (int y = 0; y < to.height; ++y) {
    const auto [v, rows] = area_weights(y, from.height, to.height);
    for (int x = 0; x < to.width; ++x) {
      const auto [u, columns] = area_weights(x, from.width, to.width);
      double sum = 0;
      for (std::size_t j = 0; j < rows.size(); ++j)
        for (std::size_t i = 0; i < columns.size(); ++i)
          sum += rows[j] * columns[i] *
                 light[(static_cast<std::size_t>(v) + j) * static_cast<std::size_t>(from.width) +
                       static_cast<std::size_t>(u) + i];
      out[static_cast<std::size_t>(y) * static_cast<std::size_t>(to.width) + static_cast<std::size_t>(x)] = sum;
    }
  }
  return out;
}

}  // namespace

std::vector<Picture> drifting_highlight(Size size, double radius, int frames) {
  std::vector<Picture> out;
  for (int n = 0; n < frames; ++n) {
    Picture picture = empty_picture(size);
    fill_ground(picture.color);
    // Not along an axis, so that it meets every phase of the pyramid's grid.
    add_disc(picture.color, size.width / 2.0 + 0.125 * n, size.height / 2.0 + 0.07 * n, radius, {60, 50, 40});
    out.push_back(std::move(picture));
  }
  return out;
}

Picture lamps(Size size) {
  struct Lamp {
    double x, y, radius;
    std::array<float, 3> light;
  };
  static constexpr Lamp kLamps[] = {{0.31, 0.42, 0.05, {8, 6, 4}},
                                    {0.92, 0.30, 0.012, {30, 28, 24}},
                                    {1.31, 0.71, 0.1, {2, 2.5f, 3}},
                                    {0.63, 0.83, 0.004, {60, 60, 60}}};
  Picture picture = empty_picture(size);
  fill_ground(picture.color);
  for (const auto& lamp : kLamps)
    add_disc(picture.color, lamp.x * size.height, lamp.y * size.height, lamp.radius * size.height, lamp.light);
  return picture;
}

Result<TemporalCurve> measure_shot(const ShotRequest& request, const std::vector<Picture>& frames,
                                   Diagnostics& diagnostics, const Step& step) {
  constexpr std::size_t kFirst = 2;
  AFTERGLOW_TRY(const auto session, open(request.preset, request.options, request.variant, diagnostics));
  TemporalCurve curve{.preset = request.preset.stem().string(),
                      .settings = request.variant.settings,
                      .scene = request.scene,
                      .size = frames.front().color.size(),
                      .radius = request.radius};
  const std::vector<bool> still = still_pixels(frames);
  const auto counted = static_cast<double>(std::ranges::count(still, true));
  std::vector<std::vector<double>> glow;
  std::vector<double> jumps, steps;
  for (std::size_t n = 0; n < frames.size(); ++n) {
    AFTERGLOW_CHECK(step(fmt::format("{} {}", request.scene, request.variant.settings)));
    AFTERGLOW_TRY(std::vector<double> light, added_light(*session, frames[n], static_cast<int>(n) + 1));
    double sum = 0;
    for (std::size_t i = 0; i < light.size(); ++i)
      if (still[i]) sum += light[i];
    if (n >= kFirst) curve.light.push_back(sum / counted);
    if (n >= kFirst) glow.push_back(std::move(light));
    if (glow.size() < 3) continue;
    const auto& a = glow[glow.size() - 3];
    const auto& b = glow[glow.size() - 2];
    const auto& c = glow.back();
    double change = 0;
    for (std::size_t i = 0; i < b.size(); ++i)
      if (still[i]) change += std::abs(b[i] - (a[i] + c[i]) / 2);
    jumps.push_back(change / counted);
    glow[glow.size() - 3].clear();  // no longer needed
    const auto l = std::span(curve.light).last(3);
    steps.push_back(std::abs(l[1] - (l[0] + l[2]) / 2));
  }
  const double mean = std::accumulate(curve.light.begin(), curve.light.end(), 0.0) /
                      static_cast<double>(std::max<std::size_t>(curve.light.size(), 1));
  if (std::abs(mean) < 1e-12) return curve;
  const auto [least, most] = std::ranges::minmax(curve.light);
  curve.swing = (most - least) / std::abs(mean);
  curve.flicker = median(steps) / std::abs(mean);
  curve.pixels = median(jumps) / std::abs(mean);
  for (double& light : curve.light) light /= mean;
  return curve;
}

Result<std::vector<ResolutionPoint>> measure_resolutions(const std::filesystem::path& preset,
                                                         const SessionOptions& options, const Variant& variant,
                                                         const std::vector<Size>& sizes, Diagnostics& diagnostics,
                                                         const Step& step) {
  AFTERGLOW_TRY(const auto session, open(preset, options, variant, diagnostics));
  const Size least = *std::ranges::min_element(sizes, {}, [](Size s) { return s.area(); });
  std::vector<double> first;
  std::vector<ResolutionPoint> out;
  for (const Size size : sizes) {
    if (static_cast<long long>(size.width) * least.height != static_cast<long long>(size.height) * least.width)
      return Error{
          ErrorKind::usage,
          fmt::format("{}x{} has another shape than {}x{}", size.width, size.height, least.width, least.height),
          "--sizes", 0, "sizes of one aspect ratio"};
    AFTERGLOW_CHECK(step(fmt::format("{}x{} {}", size.width, size.height, variant.settings)));
    AFTERGLOW_TRY(const auto light, added_light(*session, lamps(size), 1));
    const auto glow = averaged(light, size, least);
    ResolutionPoint point{.preset = preset.stem().string(), .settings = variant.settings, .size = size};
    if (first.empty()) first = glow;
    double most = 0, squares = 0, all = 0;
    for (std::size_t i = 0; i < glow.size(); ++i) {
      const double difference = std::abs(glow[i] - first[i]);
      point.worst = std::max(point.worst, difference);
      most = std::max(most, std::abs(first[i]));
      squares += difference * difference;
      all += first[i] * first[i];
    }
    point.worst = most > 0 ? point.worst / most : 0;
    point.rms = all > 0 ? std::sqrt(squares / all) : 0;
    out.push_back(point);
  }
  return out;
}

}  // namespace afterglow::bench
