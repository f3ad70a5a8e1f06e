// SPDX-License-Identifier: MIT
#include "reference/composite.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <numeric>
#include <vector>

#include "reference/color.h"
#include "reference/settings.h"

namespace afterglow::reference {
namespace {

double smoothstep(double from, double to, double x) {
  const double t = saturate((x - from) / (to - from));
  return t * t * (3 - 2 * t);
}

double screen(double a, double b) { return std::max(a, b) <= 1 ? a + b - a * b : std::max(a, b); }

double overlay(double b, double s) { return b <= 0.5 ? 2 * b * s : screen(2 * b - 1, s); }

double soft_light(double b, double s) {
  if (b >= 1) return b;
  s = saturate(s);
  if (s <= 0.5) return b - (1 - 2 * s) * b * (1 - b);
  const double d = b <= 0.25 ? ((16 * b - 12) * b + 4) * b : std::sqrt(b);
  return b + (2 * s - 1) * (d - b);
}

double in_gamma(double b, double s, double (*f)(double, double)) {
  const double made = f(std::pow(std::max(b, 0.0), 1 / 2.2), std::pow(std::max(s, 0.0), 1 / 2.2));
  return std::pow(std::max(made, 0.0), 2.2);
}

double blend_channel(double b, double s, const std::string& mode) {
  if (mode == "normal") return s;
  if (mode == "add") return b + s;
  if (mode == "screen") return screen(std::max(b, 0.0), std::max(s, 0.0));
  if (mode == "multiply") return b * s;
  if (mode == "lighten") return std::max(b, s);
  if (mode == "darken") return std::min(b, s);
  if (mode == "overlay") return in_gamma(b, s, overlay);
  if (mode == "soft_light") return in_gamma(b, s, soft_light);
  if (mode == "hard_light") return in_gamma(s, b, overlay);
  throw std::out_of_range(mode);
}

// ---- masks

using PixelMask = std::function<double(int x, int y, const Rgb& straight)>;

double in_range(double x, double from, double to, double soft) {
  return smoothstep(from - soft, from, x) * (1 - smoothstep(to, to + soft, x));
}

/// Of a range in settings; nothing lies in one that ends before it begins.
std::function<double(double)> range_of(const Settings& s) {
  if (s.number("from") > s.number("to")) return [](double) { return 0.0; };
  return [from = s.number("from"), to = s.number("to"), soft = std::max(s.number("softness"), 1e-6)](double x) {
    return in_range(x, from, to, soft);
  };
}

PixelMask hue_mask(const Settings& s) {
  const double center = s.number("center"), half = s.number("width") / 2, soft = std::max(s.number("softness"), 1e-4),
               saturation = std::max(s.number("saturation"), 1e-6);
  return [=](int, int, const Rgb& color) {
    const Rgb c = glm::max(color, Rgb(0));
    const double high = std::max({c.r, c.g, c.b}), spread = high - std::min({c.r, c.g, c.b});
    if (spread <= 0) return 0.0;
    const double sixths = high == c.r   ? (c.g - c.b) / spread
                          : high == c.g ? 2 + (c.b - c.r) / spread
                                        : 4 + (c.r - c.g) / spread;
    const double away = std::abs(std::remainder(60 * sixths - center, 360.0));
    return (1 - smoothstep(half, half + soft, away)) * smoothstep(0, saturation, spread / high);
  };
}

PixelMask radial_mask(const Settings& s, Size size) {
  const auto [cx, cy] = s.pair("center");
  const auto [wide, high] = s.pair("radius");
  if (wide <= 0 || high <= 0) return [](int, int, const Rgb&) { return 0.0; };
  const double rx = std::max(wide, 1e-6), ry = std::max(high, 1e-6);
  const double soft = std::max(s.number("softness"), 1e-6), angle = s.number("rotation") * std::numbers::pi / 180;
  return [=, cx = cx, cy = cy](int x, int y, const Rgb&) {
    const double dx = (x + 0.5 - cx * size.width) / size.height, dy = (y + 0.5 - cy * size.height) / size.height;
    const double ex = (std::cos(angle) * dx + std::sin(angle) * dy) / rx,
                 ey = (std::cos(angle) * dy - std::sin(angle) * dx) / ry;
    return 1 - smoothstep(0, soft, (std::hypot(ex, ey) - 1) * std::min(rx, ry));
  };
}

PixelMask linear_mask(const Settings& s, Size size) {
  const auto [fx, fy] = s.pair("from");
  const auto [tx, ty] = s.pair("to");
  return [=, fx = fx, fy = fy, tx = tx, ty = ty](int x, int y, const Rgb&) {
    const double wx = (tx - fx) * size.width, wy = (ty - fy) * size.height;
    const double along = (x + 0.5 - fx * size.width) * wx + (y + 0.5 - fy * size.height) * wy;
    return smoothstep(0, 1, along / (wx * wx + wy * wy));
  };
}

PixelMask layer_mask(const Settings& s, const Inputs& inputs) {
  const DoubleImage* layer = inputs.layers.at(s.text("layer"));
  const std::string channel = s.text("channel");
  return [=](int x, int y, const Rgb&) {
    const Rgba& p = layer->at(x, y);
    return channel == "luma" ? luminance(Rgb(p))
           : channel == "r"  ? p.r
           : channel == "g"  ? p.g
           : channel == "b"  ? p.b
                             : p.a;
  };
}

/// Smoothed by (1, 2, 1) / 4 along both axes, pixels beyond the border being those at it.
PixelMask id_mask(const Settings& s, const Inputs& inputs) {
  const DoubleImage* layer = inputs.layers.at(s.text("layer"));
  const auto is = [layer, index = s.number("index")](int x, int y) {
    return layer->clamped(x, y).r == index ? 1.0 : 0.0;
  };
  if (!s.flag("antialias")) return [=](int x, int y, const Rgb&) { return is(x, y); };
  return [=](int x, int y, const Rgb&) {
    double sum = 0;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) sum += is(x + dx, y + dy) * (2 - std::abs(dx)) * (2 - std::abs(dy)) / 16;
    return sum;
  };
}

/// The mask of whole pixels under a Gaussian, cut at three standard deviations; pixels beyond the border being those at
/// it.
PixelMask feathered(const PixelMask& mask, const Settings& s, Size size) {
  const double deviation = s.number("feather");
  if (deviation < 0.1) return mask;
  const int reach = static_cast<int>(std::ceil(3 * deviation));
  std::vector<double> weights;
  for (int i = -reach; i <= reach; ++i) weights.push_back(std::exp(-0.5 * i * i / (deviation * deviation)));
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  const auto blurred = [&](const auto& value) {  // along one axis
    auto out = std::make_shared<std::vector<double>>(static_cast<std::size_t>(size.area()));
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x)
        for (int i = -reach; i <= reach; ++i)
          (*out)[static_cast<std::size_t>(y) * size.width + x] +=
              weights[static_cast<std::size_t>(i + reach)] / sum * value(x, y, i);
    return out;
  };
  const auto across =
      blurred([&](int x, int y, int i) { return mask(std::clamp(x + i, 0, size.width - 1), y, Rgb(0)); });
  const auto both = blurred([&](int x, int y, int i) {
    return (*across)[static_cast<std::size_t>(std::clamp(y + i, 0, size.height - 1)) * size.width + x];
  });
  return
      [both, width = size.width](int x, int y, const Rgb&) { return (*both)[static_cast<std::size_t>(y) * width + x]; };
}

PixelMask pixel_mask(const Mask& mask, const Inputs& inputs, Size size) {
  const Entry entry{.effect = mask.name, .settings = mask.settings};
  const Settings s(entry);
  if (mask.name == "luma") return [range = range_of(s)](int, int, const Rgb& c) { return range(luminance(c)); };
  if (mask.name == "depth")
    return [range = range_of(s), depth = inputs.depth](int x, int y, const Rgb&) { return range(depth->at(x, y).r); };
  if (mask.name == "hue") return hue_mask(s);
  if (mask.name == "radial") return radial_mask(s, size);
  if (mask.name == "linear") return linear_mask(s, size);
  return feathered(mask.name == "id" ? id_mask(s, inputs) : layer_mask(s, inputs), s, size);
}

}  // namespace

Rgb blend(const Rgb& below, const Rgb& above, const std::string& mode) {
  const auto with_colour_of = [](const Rgb& from, const Rgb& light) {
    const Rgb c = glm::max(from, Rgb(0)) + 1e-4;
    return luminance(glm::max(light, Rgb(0))) / luminance(c) * c;
  };
  if (mode == "color") return with_colour_of(above, below);
  if (mode == "luminosity") return with_colour_of(below, above);
  return {blend_channel(below.r, above.r, mode), blend_channel(below.g, above.g, mode),
          blend_channel(below.b, above.b, mode)};
}

bool is_known(const Mask& mask) {
  if (mask.a) return is_known(*mask.a) && is_known(*mask.b);
  static constexpr const char* kNames[] = {"depth", "hue", "id", "layer", "linear", "luma", "radial"};
  return mask.kind == Mask::Kind::number || std::ranges::find(kNames, mask.name) != std::end(kNames);
}

std::vector<double> mask_of(const DoubleImage& source, const Inputs& inputs, const Mask& mask) {
  std::vector<double> out(source.pixels.size(), mask.number);
  if (mask.kind == Mask::Kind::number) return out;
  if (mask.kind == Mask::Kind::named) {
    const PixelMask at = pixel_mask(mask, inputs, source.size());
    for (int y = 0; y < source.height; ++y)
      for (int x = 0; x < source.width; ++x) {
        const Rgba& p = source.at(x, y);
        out[static_cast<std::size_t>(y) * source.width + x] = saturate(at(x, y, Rgb(p) / cover(p)));
      }
    return out;
  }
  const auto a = mask_of(source, inputs, *mask.a), b = mask_of(source, inputs, *mask.b);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = saturate(mask.kind == Mask::Kind::add        ? a[i] + b[i]
                      : mask.kind == Mask::Kind::subtract ? a[i] - b[i]
                                                          : a[i] * b[i]);
  return out;
}

DoubleImage composite(const DoubleImage& below, const DoubleImage& above, double opacity, const std::string& mode,
                      const std::vector<double>* mask) {
  DoubleImage out = below;
  for (std::size_t i = 0; i < out.pixels.size(); ++i) {
    const Rgba& p = below.pixels[i];
    const double k = cover(p), share = opacity * (mask ? saturate((*mask)[i]) : 1);
    const Rgb made = blend(Rgb(p) / k, Rgb(above.pixels[i]) / k, mode) * k;
    out.pixels[i] = Rgba(Rgb(p) * (1 - share) + made * share, p.a);
  }
  return out;
}

}  // namespace afterglow::reference
