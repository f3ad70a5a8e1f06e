// SPDX-License-Identifier: MIT
// What the view shows of a picture, in double precision on the CPU: written from view_pass.h, not from the shader.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "image/image.h"
#include "window/view_pass.h"

namespace afterglow {

using Rgb = std::array<double, 3>;

class ViewOracle {
 public:
  /// `display`: the pass has this table.
  ViewOracle(const ViewFrame& frame, const Image& shown, const Image* compared, const DisplayTable* display = nullptr)
      : frame_(frame),
        place_(placement(frame.view, frame.picture, frame.area.size())),
        shown_(shown),
        compared_(compared),
        display_(display) {}

  /// Codes in 0…1 of a pixel of the target, which lies within the area.
  Rgb at(int x, int y) const {
    const double sx = x - frame_.area.x + 0.5, sy = y - frame_.area.y + 0.5;
    const Point p = to_picture(place_, {sx, sy});
    if (p.x < 0 || p.y < 0 || p.x >= frame_.picture.width || p.y >= frame_.picture.height) return coded(frame_.outside);
    const View& view = frame_.view;
    const Image* image = &shown_;
    if (view.compare != Compare::none && compared_ && view.by == CompareBy::difference) {
      Image apart(shown_.width, shown_.height, 4);
      for (std::size_t i = 0; i < apart.pixels.size(); ++i)
        apart.pixels[i] = i % 4 == 3 ? 1 : std::abs(shown_.pixels[i] - compared_->pixels[i]);
      return looked_at(apart, p, x, y);
    }
    if (view.compare != Compare::none && compared_) {
      const Point border = to_screen(place_, {view.wipe * frame_.picture.width, view.wipe * frame_.picture.height});
      const double distance = view.wipe_vertical ? sy - border.y : sx - border.x;
      if (std::abs(distance) < frame_.pixel_scale) return encode({0.8, 0.8, 0.8});
      if (std::abs(distance) < frame_.pixel_scale + 1) return encode({0.02, 0.02, 0.02});
      if (distance < 0) image = compared_;
    }
    return looked_at(*image, p, x, y);
  }

 private:
  static Rgb coded(const ViewColor& c) { return {c[0], c[1], c[2]}; }
  static Rgb encode(Rgb c) {
    for (double& v : c) {
      v = std::clamp(v, 0.0, 1.0);
      v = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
    }
    return c;
  }
  /// As light is shown.
  Rgb lit(const Rgb& c) const {
    const bool apart = frame_.view.compare != Compare::none && compared_ && frame_.view.by == CompareBy::difference;
    if (!display_ || !frame_.view.as_display || apart) return encode(c);
    return read_display_table(*display_, c);
  }
  static double luminance(const float* c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; }

  /// 0 nothing, 1 above, 2 below, 3 not finite
  int mark_of(const float* c) const {
    const double gain = std::exp2(frame_.view.exposure);
    const auto one = [](double v) { return !std::isfinite(v) ? 3 : v < -1e-4 ? 2 : v > 1 + 1e-4 ? 1 : 0; };
    switch (frame_.view.channel) {
      case ViewChannel::color:
        return std::max({one(c[0] * gain), one(c[1] * gain), one(c[2] * gain)});
      case ViewChannel::red:
        return one(c[0] * gain);
      case ViewChannel::green:
        return one(c[1] * gain);
      case ViewChannel::blue:
        return one(c[2] * gain);
      case ViewChannel::alpha:
        return one(c[3]);
      default:
        return one(luminance(c) * gain);
    }
  }

  Rgb zone(const std::array<double, 4>& c, double gain) const {
    double light = (0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]) * gain;
    if (frame_.view.channel == ViewChannel::red) light = c[0] * gain;
    if (frame_.view.channel == ViewChannel::green) light = c[1] * gain;
    if (frame_.view.channel == ViewChannel::blue) light = c[2] * gain;
    if (frame_.view.channel == ViewChannel::alpha) light = c[3];
    std::size_t at = 0;
    while (at + 1 < kZones.size() && light >= 0.18 * std::exp2(kFirstZone + static_cast<int>(at) + 0.5)) ++at;
    return coded(kZones[at]);
  }

  Rgb looked_at(const Image& image, Point p, int x, int y) const {
    const double kx = static_cast<double>(image.width) / frame_.picture.width;
    const double ky = static_cast<double>(image.height) / frame_.picture.height;
    const double w = kx / place_.scale, h = ky / place_.scale;
    std::array<double, 4> sum{};
    double total = 0;
    int worst = 0;
    const auto add = [&](int ix, int iy, double weight) {
      if (!(weight > 0)) return;
      const float* c = image.at(std::clamp(ix, 0, image.width - 1), std::clamp(iy, 0, image.height - 1));
      for (int i = 0; i < 4; ++i) {
        sum[i] += weight * (std::isnan(c[i]) ? 0.0 : std::clamp(static_cast<double>(c[i]), -1e30, 1e30));
      }
      total += weight;
      worst = std::max(worst, mark_of(c));
    };
    if (w <= 1 && h <= 1 && frame_.view.smooth) {
      const double ax = p.x * kx - 0.5, ay = p.y * ky - 0.5;
      for (int iy = static_cast<int>(std::floor(ay)); iy <= std::floor(ay) + 1; ++iy)
        for (int ix = static_cast<int>(std::floor(ax)); ix <= std::floor(ax) + 1; ++ix)
          add(ix, iy, (1 - std::abs(ax - ix)) * (1 - std::abs(ay - iy)));
    } else if (w <= 1 && h <= 1) {
      add(static_cast<int>(std::floor(p.x * kx)), static_cast<int>(std::floor(p.y * ky)), 1);
    } else {
      const double rw = std::max(w, 1.0), rh = std::max(h, 1.0);
      for (int iy = 0; iy < image.height; ++iy) {
        const double vertical = std::min(iy + 1.0, p.y * ky + rh / 2) - std::max<double>(iy, p.y * ky - rh / 2);
        if (vertical <= 0) continue;
        for (int ix = 0; ix < image.width; ++ix) {
          const double across = std::min(ix + 1.0, p.x * kx + rw / 2) - std::max<double>(ix, p.x * kx - rw / 2);
          if (across > 0) add(ix, iy, across * vertical);
        }
      }
    }
    for (double& v : sum) v /= total;
    const Marks marks = frame_.view.marks;
    if (marks != Marks::none && worst == 3) return coded(kMarkNotFinite);
    if (marks == Marks::range && worst > 0) return coded(worst == 2 ? kMarkBelow : kMarkAbove);
    const double gain = std::exp2(frame_.view.exposure);
    if (marks == Marks::stops) return zone(sum, gain);
    const auto toned = [&](double v) { return std::copysign(std::pow(std::abs(v * gain), 1 / frame_.view.gamma), v); };
    const double r = toned(sum[0]), g = toned(sum[1]), b = toned(sum[2]);
    const auto gray = [this](double v) { return lit({v, v, v}); };
    switch (frame_.view.channel) {
      case ViewChannel::red:
        return gray(r);
      case ViewChannel::green:
        return gray(g);
      case ViewChannel::blue:
        return gray(b);
      case ViewChannel::alpha:
        return encode({sum[3], sum[3], sum[3]});
      case ViewChannel::luminance:
        return gray(0.2126 * r + 0.7152 * g + 0.0722 * b);
      default:
        break;
    }
    if (marks == Marks::range) return gray(0.2126 * r + 0.7152 * g + 0.0722 * b);
    double background = 0;
    if (frame_.background == ViewBackground::gray) background = 0.18;
    if (frame_.background == ViewBackground::checker) {
      const double side = 12 * frame_.pixel_scale;
      const int square =
          static_cast<int>(std::floor((x + 0.5) / side)) + static_cast<int>(std::floor((y + 0.5) / side));
      background = square % 2 == 0 ? 0.08 : 0.25;
    }
    const double through = background * std::clamp(1 - sum[3], 0.0, 1.0);
    return lit({r + through, g + through, b + through});
  }

  const ViewFrame& frame_;
  ViewPlacement place_;
  const Image& shown_;
  const Image* compared_;
  const DisplayTable* display_;
};

}  // namespace afterglow
