// SPDX-License-Identifier: MIT
#include "reference/grading.h"

#include <cmath>
#include <glm/matrix.hpp>

#include "reference/color.h"

namespace afterglow::reference {

namespace {

double smoothstep(double from, double to, double x) {
  const double t = saturate((x - from) / (to - from));
  return t * t * (3 - 2 * t);
}

/// Matrix from its rows.
glm::dmat3 rows(const Rgb& a, const Rgb& b, const Rgb& c) { return glm::transpose(glm::dmat3(a, b, c)); }

/// Cones of CAT02 for the colour of chromaticity (x, y) and Y = 1.
Rgb cones_of(double x, double y) {
  const Rgb xyz(x / y, 1, (1 - x - y) / y);
  return rows({0.7328, 0.4296, -0.1624}, {-0.7036, 1.6975, 0.0061}, {0.0030, 0.0136, 0.9834}) * xyz;
}

/// y on the daylight locus.
double judd(double x) { return 2.87 * x - 3 * x * x - 0.27509507; }

/// x of daylight of 4000…25000 K (CIE 15).
double daylight_x(double kelvin) {
  const double t = 1000 / kelvin, t2 = t * t, t3 = t2 * t;
  return kelvin <= 7000 ? 0.244063 + 0.09911 * t + 2.9678 * t2 - 4.6070 * t3
                        : 0.237040 + 0.24748 * t + 1.9018 * t2 - 2.0064 * t3;
}

/// What is brighter than white stays.
double soft_light(double base, double blend) {
  if (base >= 1) return base;
  if (blend < 0.5) return 2 * base * blend + base * base * (1 - 2 * blend);
  return std::sqrt(base) * (2 * blend - 1) + 2 * base * (1 - blend);
}

Rgb factor(const Rgb& color, double offset) { return glm::max(color + offset * (offset < 0 ? 1.0 : 4.0), Rgb(0)); }

/// A wheel's colour without its luminance.
Rgb chroma(const Rgb& color, double scale) {
  return scale * (color - (0.2126729 * color.r + 0.7151522 * color.g + 0.0721750 * color.b) / 1.0000001);
}

}  // namespace

glm::dvec2 white_of_kelvin(double kelvin) {
  const double x_of_day = daylight_x(kelvin) + 0.31271 - daylight_x(6504);  // D65's own x has other last digits
  const glm::dvec2 day(x_of_day, judd(x_of_day));
  if (kelvin >= 4000) return day;
  const double t = 1000 / kelvin, t2 = t * t, t3 = t2 * t;
  glm::dvec2 lamp(0.179910 + 0.8776956 * t - 0.2343589 * t2 - 0.2661239 * t3, 0);
  const double x = lamp.x, x2 = x * x, x3 = x2 * x;
  lamp.y = kelvin < 2222 ? -1.1063814 * x3 - 1.34811020 * x2 + 2.18555832 * x - 0.20219683
                         : -0.9549476 * x3 - 1.37418593 * x2 + 2.09137015 * x - 0.16748867;
  return glm::mix(day, lamp, saturate((1 / kelvin - 1 / 4000.0) / (1 / 2900.0 - 1 / 4000.0)));
}

DoubleImage white_balance(const DoubleImage& source, const WhiteBalance& s) {
  const double t1 = s.temperature / 65, t2 = s.tint / 65;
  const glm::dvec2 white = white_of_kelvin(s.kelvin);
  const double x = white.x - t1 * (t1 < 0 ? 0.1 : 0.05);
  const double y = judd(x) + (white.y - judd(white.x)) + t2 * 0.05;
  const Rgb neutral(0.949237, 1.03542, 1.08728), cones = cones_of(x, y);
  Rgb balance;
  for (int i = 0; i < 3; ++i) balance[i] = cones[i] * 16 > neutral[i] ? neutral[i] / cones[i] : 16;
  const auto to_cones = rows({3.90405e-1, 5.49941e-1, 8.92632e-3}, {7.08416e-2, 9.63172e-1, 1.35775e-3},
                             {2.31082e-2, 1.28021e-1, 9.36245e-1});
  const auto from_cones = rows({2.85847e+0, -1.62879e+0, -2.48910e-2}, {-2.10182e-1, 1.15820e+0, 3.24281e-4},
                               {-4.18120e-2, -1.18169e-1, 1.06867e+0});
  return map_color(source, [&](const Rgb& c) { return glm::max(from_cones * (balance * (to_cones * c)), Rgb(0)); });
}

DoubleImage channel_mixer(const DoubleImage& source, const ChannelMix& mix) {
  return map_color(source, [&](const Rgb& c) {
    Rgb out;
    for (int i = 0; i < 3; ++i) out[i] = glm::max(0.0, (mix[i][0] * c.r + mix[i][1] * c.g + mix[i][2] * c.b) / 100);
    return out;
  });
}

DoubleImage split_toning(const DoubleImage& source, const SplitToning& s) {
  return map_straight(source, [&](const Rgb& c) {
    Rgb out;
    for (int i = 0; i < 3; ++i) out[i] = std::pow(c[i], 1 / 2.2);
    const double bright = saturate(luminance(glm::min(out, Rgb(1))) + s.balance / 100);
    for (int i = 0; i < 3; ++i) {
      out[i] = soft_light(out[i], s.shadows[i] + (0.5 - s.shadows[i]) * bright);
      out[i] = soft_light(out[i], 0.5 + (s.highlights[i] - 0.5) * bright);
      out[i] = std::pow(out[i], 2.2);
    }
    return out;
  });
}

DoubleImage shadows_midtones_highlights(const DoubleImage& source, const ShadowsMidtonesHighlights& s) {
  const Rgb shadows = factor(s.shadows, s.shadows_offset), midtones = factor(s.midtones, s.midtones_offset),
            highlights = factor(s.highlights, s.highlights_offset);
  // Limits that meet or cross are a hard edge at the first.
  const auto behind = [](double end, double start) { return std::max(end, start * 1.0001 + 1e-5); };
  const double shadows_end = behind(s.shadows_end, s.shadows_start),
               highlights_end = behind(s.highlights_end, s.highlights_start);
  return map_straight(source, [&](const Rgb& c) {
    const double y = luminance(c);
    const double in_shadows = 1 - smoothstep(s.shadows_start, shadows_end, y);
    const double in_highlights = smoothstep(s.highlights_start, highlights_end, y);
    const double in_midtones = 1 - in_shadows - in_highlights;
    return glm::max(c * shadows * in_shadows + c * midtones * in_midtones + c * highlights * in_highlights, Rgb(0));
  });
}

DoubleImage lift_gamma_gain(const DoubleImage& source, const LiftGammaGain& s) {
  const Rgb lift = chroma(s.lift, 0.15) + s.lift_offset;
  const Rgb power = 1.0 / glm::max(chroma(s.gamma, 0.8) + 1.0 + s.gamma_offset, Rgb(1e-3));
  const Rgb gain = chroma(s.gain, 0.8) + 1.0 + s.gain_offset;
  return map_straight(source, [&](const Rgb& c) {
    const Rgb scaled = c * gain + lift;
    Rgb out;
    for (int i = 0; i < 3; ++i) out[i] = scaled[i] > 0 ? glm::min(std::pow(scaled[i], power[i]), kMostLight) : 0;
    return out;
  });
}

DoubleImage exposure(const DoubleImage& source, double ev) {
  return map_color(source, [&](const Rgb& c) { return c * std::exp2(ev); });
}

DoubleImage cdl(const DoubleImage& source, const Cdl& s) {
  return map_straight(source, [&](const Rgb& c) {
    const Rgb graded = glm::min(glm::pow(glm::max(c * s.slope + s.offset, Rgb(0)), s.power), Rgb(kMostLight));
    const double luma = glm::dot(graded, Rgb(0.2126, 0.7152, 0.0722));
    // Not luma + s·(graded − luma): the luma of a strong power leaves the other channels no digit, even here.
    return glm::clamp(s.saturation * graded + (1 - s.saturation) * luma, Rgb(0), Rgb(kMostLight));
  });
}

namespace {

/// The gain, as a factor, of light that is `v` bright.
double gain(const std::array<double, 5>& y, double v) {
  const auto slope = [&](int i) {
    if (i == 0 || i == 4) return 0.0;
    const double before = y[i] - y[i - 1], behind = y[i + 1] - y[i];
    return before * behind > 0 ? 2 / (1 / before + 1 / behind) : 0.0;
  };
  if (v <= 0) return std::exp2(y.front());
  const double stops = std::log2(v / 0.18);
  if (stops <= -6) return std::exp2(y.front());
  if (stops >= 6) return std::exp2(y.back());
  const int i = static_cast<int>((stops + 6) / 3);
  const double t = (stops + 6) / 3 - i, u = 1 - t;
  // Bernstein's form of the same cubic.
  const double stop = u * u * u * y[i] + 3 * u * u * t * (y[i] + slope(i) / 3) +
                      3 * u * t * t * (y[i + 1] - slope(i + 1) / 3) + t * t * t * y[i + 1];
  return std::exp2(stop);
}

Rgb by_hue(const Rgb& c, const std::array<Rgb, 6>& hues) {
  Rgb hsv = rgb_to_hsv(c, kNoHsvEpsilon);
  const double at = hsv.x * 6, whole = std::floor(at), t = at - whole;
  const int i = static_cast<int>(whole) % 6;
  const Rgb change = glm::mix(hues[i], hues[(i + 1) % 6], t * t * (3 - 2 * t));
  const double saturation = hsv.y;
  hsv.x = rotate_hue(hsv.x + change.x * 0.3 / 360);
  const Rgb turned = hsv_to_rgb(hsv);
  const double y = luminance(turned);
  return glm::max(y + (turned - y) * (1 + change.y / 100), Rgb(0)) * std::exp2(change.z / 100 * saturation);
}

}  // namespace

DoubleImage curves(const DoubleImage& source, const Curves& s) {
  const bool any_hue = std::ranges::any_of(s.hues, [](const Rgb& h) { return h != Rgb(0); });
  return map_straight(source, [&](const Rgb& c) {
    Rgb graded = s.by_luminance ? c * gain(s.master, luminance(c)) : c;
    for (int i = 0; i < 3; ++i) {
      const auto& [low, middle, high] = s.channels[i];
      std::array<double, 5> y{low, low, middle, high, high};
      for (int point = 0; !s.by_luminance && point < 5; ++point) y[point] += s.master[point];
      graded[i] *= gain(y, graded[i]);
    }
    return any_hue ? by_hue(graded, s.hues) : graded;
  });
}

}  // namespace afterglow::reference
