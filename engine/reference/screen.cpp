// SPDX-License-Identifier: MIT
#include "reference/screen.h"

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "reference/glow.h"
#include "reference/resample.h"

namespace afterglow::reference {
namespace {

/// How much of pixel `at` lies in the window of this length.
double in_window(int at, int n, double length, double offset) {
  const double from = (n - length) / 2 * (1 + offset);
  return glm::clamp(glm::min(at + 1.0, from + length) - glm::max<double>(at, from), 0.0, 1.0);
}

/// How much of pixel x lies in a stripe a third of a triad wide.
double striped(int x, double triad, double from) {
  const auto covered = [&](double at) { return std::floor(at) / 3 + glm::min(at - std::floor(at), 1.0 / 3); };
  return (covered((x + 1) / triad - from) - covered(x / triad - from)) * triad;
}

struct Tube {
  const DoubleImage& signal;
  const Crt& s;
  int reach = glm::max(2, static_cast<int>(std::ceil(2.5 * s.softness)));
  double cut = std::exp(-0.5 * std::pow((reach + 0.5) / s.softness, 2));

  double beam(double x, int y, int channel) const {
    const double middle = std::floor(x);
    double sum = 0, weights = 0;
    for (int i = -reach; i <= reach; ++i) {
      const double d = (middle + i + 0.5 - x) / s.softness, w = glm::max(std::exp(-0.5 * d * d) - cut, 0.0);
      sum += w * glm::clamp(signal.clamped(static_cast<int>(middle) + i, y)[channel], 0.0, 1.0);
      weights += w;
    }
    return sum / glm::max(weights, 1e-20);
  }

  /// At d lines from a line's middle.
  static double across_line(double d, double sigma) {
    const double variance = sigma * sigma, end = std::exp(-1.125 / variance);
    const double mean = std::sqrt(glm::two_pi<double>()) * sigma * (1 - 0.243 * end) - 3 * end;
    return glm::max(std::exp(-0.5 * d * d / variance) - end, 0.0) / mean;
  }

  double light(double x, double y, int channel, double dark) const {
    const int line = static_cast<int>(std::floor(y));
    double even = 0, sharp = 0;
    for (int i = -1; i <= 1; ++i) {
      const double v = beam(x + (channel - 1) * s.convergence, line + i, channel);
      const double sigma = 0.25 + 0.25 * std::sqrt(v), d = line + i + 0.5 - y;
      sharp += v * across_line(d, sigma);
      even += v * glm::max(0.0, 1 - std::abs(d));
    }
    return even + (sharp - even) * dark;
  }
};

}  // namespace

DoubleImage letterbox(const DoubleImage& source, const Letterbox& s) {
  const auto shown = [](int n, double length) {
    const double bars = glm::max(n - length, 0.0);
    return bars < 0.5 ? n : bars < 1 ? n + 1 - 2 * bars : length;
  };
  const double across = shown(source.width, source.height * s.aspect);
  const double down = shown(source.height, source.width / s.aspect);
  return generate(source.size(), [&](int x, int y) {
    const Rgba& p = source.at(x, y);
    const double share = in_window(x, source.width, across, s.offset) * in_window(y, source.height, down, s.offset);
    return Rgba(glm::mix(s.color * p.a, Rgb(p), share), p.a);
  });
}

DoubleImage crt(const DoubleImage& source, const Crt& s) {
  const int down = glm::min(s.lines, source.height);
  const double width = static_cast<double>(source.width) * down / source.height;
  const int across = glm::max(1, glm::min(source.width, static_cast<int>(std::floor(width + 0.5))));
  const DoubleImage signal = resized_to(source, {across, down});
  const DoubleImage spread =
      s.glow > 0 ? glow_of(glow_half(signal), signal.size(), fog_weights(signal.size(), 0.06 * down)) : signal;
  const double dark = s.scan_lines * glm::clamp(static_cast<double>(source.height) / down - 2, 0.0, 1.0);
  const double aspect = static_cast<double>(source.width) / source.height, bend = 0.25 * s.curvature;
  const double corner = glm::max(s.corner, 1e-4);
  const Tube tube{signal, s};
  return generate(source.size(), [&](int x, int y) {
    const double u = (2 * x + 1.0) / source.width - 1, v = (2 * y + 1.0) / source.height - 1;
    const double p = u * (1 + 0.5 * bend * v * v), q = v * (1 + 0.7 * bend * u * u);
    const double over_x = std::abs(p) * aspect - aspect + 2 * corner, over_y = std::abs(q) - 1 + 2 * corner;
    const double outside =
        std::hypot(glm::max(over_x, 0.0), glm::max(over_y, 0.0)) + glm::min(glm::max(over_x, over_y), 0.0) - 2 * corner;
    const double shown = glm::clamp(0.5 - outside / (3.0 / source.height), 0.0, 1.0);
    const double lost = s.vignette * glm::min(0.5 * (p * p + q * q), 1.0);
    const double px = (p / 2 + 0.5) * signal.width, py = (q / 2 + 0.5) * signal.height;
    const Rgba around = sample_linear(spread, px, py);
    Rgba out(0, 0, 0, source.at(x, y).a);
    for (int c = 0; shown > 0 && c < 3; ++c) {
      double light = tube.light(px, py, c, dark) * (1 - s.glow) + glm::clamp(around[c], 0.0, 1.0) * s.glow;
      const double stripe = striped(x, s.phosphor_size, c / 3.0);
      light *= 1 + s.phosphor * glm::clamp(s.phosphor_size - 2, 0.0, 1.0) * (1 - glm::clamp(light, 0.0, 1.0)) *
                       (3 * stripe - 1);
      out[c] = light * s.brightness * (1 - lost) * shown;
    }
    return Rgba(glm::mix(Rgb(source.at(x, y)), Rgb(out), s.intensity), out.a);
  });
}

DoubleImage posterize(const DoubleImage& source, const Posterize& s) {
  return map_straight(source, [&](const Rgb& c) {
    const double eye = std::sqrt(glm::max(0.2126729 * c.r + 0.7151522 * c.g + 0.0721750 * c.b, 0.0));
    if (eye > 1) return c;
    const double at = eye * (s.levels - 1), below = std::floor(at);
    const double slope = glm::clamp((at - below - 0.5) / glm::max(s.softness, 1e-3) + 0.5, 0.0, 1.0);
    const double steps = s.levels - 1, lower = below > 0 ? below / steps : glm::min(eye, s.shadows / steps);
    const double scale = glm::mix(lower, (below + 1) / steps, slope) / glm::max(eye, 1e-6);
    const double most = glm::max(c.r, glm::max(c.g, c.b));
    return glm::mix(c, c * glm::min(scale * scale, glm::max(1.0, 1 / glm::max(most, 1e-6))), s.intensity);
  });
}

}  // namespace afterglow::reference
