// SPDX-License-Identifier: MIT
#include "reference/bloom.h"

#include <array>

#include "reference/color.h"
#include "reference/resample.h"

namespace afterglow::reference {

namespace {

constexpr double kScatterIntensityLimit = 0.95;  // the original always contributes (math.md §12 #2)
constexpr std::array kHalving = {0.22702703, 0.19459459, 0.12162162, 0.05405405, 0.01621622};
constexpr std::array kVerticalOffsets = {0.0, 1.38461538, 3.23076923};
constexpr std::array kVerticalWeights = {0.22702703, 0.31621622, 0.07027027};

Size half(Size size) { return {size.width / 2, size.height / 2}; }

/// Bilinear sample of `source` at the centre of pixel (x, y) of a target of `size`, plus an offset in texels of the
/// source.
Rgba fetch(const DoubleImage& source, Size size, int x, int y, double dx = 0, double dy = 0,
           Edges edges = Edges::stretch) {
  return sample_linear(source, source_position(x, source.width, size.width) + dx,
                       source_position(y, source.height, size.height) + dy, edges);
}

/// Pixel by pixel f(up, high) on colours; alpha of high.
template <class F>
DoubleImage combine(const DoubleImage& up, const DoubleImage& high, F&& f) {
  return generate(high.size(), [&](int x, int y) {
    const Rgba& h = high.at(x, y);
    return Rgba(f(Rgb(up.at(x, y)), Rgb(h)), h.a);
  });
}

/// The colour as if its brightest channel were at most `most`; 0: as it is.
Rgb held(const Rgb& c, double most) {
  const double b = glm::max(c.r, glm::max(c.g, c.b));
  return most > 0 && b > most ? c * (most / b) : c;
}

}  // namespace

BloomThreshold BloomThreshold::from_gamma(double threshold, double knee) { return {gamma_to_linear(threshold), knee}; }

Rgb BloomThreshold::operator()(const Rgb& c) const {
  const double b = glm::max(c.r, glm::max(c.g, c.b));
  const double tk = t * knee;
  const double ramp = glm::clamp(b - t + tk, 0.0, 2 * tk);
  const double s = ramp * ramp * 0.25 / (tk + 1e-5);
  return c * (glm::max(s, b - t) / glm::max(b, 1e-5));
}

Size bloom_scaled_size(Size size, int height) {
  const long long w = size.width, h = size.height;
  return {glm::max(1, static_cast<int>((2 * w * height + h) / (2 * h))), height};
}

DoubleImage bloom_scaled(const DoubleImage& source, Size wanted) {
  const auto resized = [](const DoubleImage& from, Size size, int nx, int ny) {
    const double step_x = static_cast<double>(from.width) / size.width / nx;
    const double step_y = static_cast<double>(from.height) / size.height / ny;
    return generate(size, [&](int x, int y) {
      Rgba sum(0);
      for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i)
          sum += fetch(from, size, x, y, (i - (nx - 1) / 2.0) * step_x, (j - (ny - 1) / 2.0) * step_y);
      return sum / static_cast<double>(nx * ny);
    });
  };
  DoubleImage image = source;
  while (image.height >= 2 * wanted.height && image.width >= 2 * wanted.width)
    image = resized(image, half(image.size()), 1, 1);
  if (image.size() == wanted) return image;
  const auto reads = [](int from, int to) {
    return static_cast<int>(mean_over(static_cast<double>(from) / to).size());
  };
  return resized(image, wanted, reads(image.width, wanted.width), reads(image.height, wanted.height));
}

DoubleImage bloom_prefilter(const DoubleImage& source, const BloomThreshold& threshold) {
  const Size size = half(source.size());
  return generate(size, [&](int x, int y) {
    const Rgba c = fetch(source, size, x, y);
    return Rgba(threshold(Rgb(c)), c.a);
  });
}

DoubleImage bloom_prefilter_fireflies(const DoubleImage& source, const BloomThreshold& threshold) {
  return bloom_fade_fireflies(source, half(source.size()), threshold);
}

DoubleImage bloom_fade_fireflies(const DoubleImage& source, Size size, const BloomThreshold& threshold) {
  static constexpr int kOffsets[5][2] = {{0, 0}, {-2, -2}, {-2, 2}, {2, -2}, {2, 2}};
  return generate(size, [&](int x, int y) {
    Rgb sum(0);
    double weights = 0;
    for (const auto& o : kOffsets) {
      const Rgb c = threshold(Rgb(fetch(source, size, x, y, o[0], o[1])));
      const double w = 1 / (luminance(c) + 1);
      sum += w * c;
      weights += w;
    }
    return Rgba(sum / weights, 1);
  });
}

DoubleImage bloom_horizontal(const DoubleImage& source, Edges edges) {
  const Size size = half(source.size());
  return generate(size, [&](int x, int y) {
    Rgba sum(0);
    for (int i = -4; i <= 4; ++i) sum += kHalving[glm::abs(i)] * fetch(source, size, x, y, 2.0 * i, 0, edges);
    return sum;
  });
}

DoubleImage bloom_vertical(const DoubleImage& source, Edges edges) {
  const Size size = source.size();
  return generate(size, [&](int x, int y) {
    Rgba sum = kVerticalWeights[0] * source.at(x, y);
    for (int i = 1; i <= 2; ++i)
      sum += kVerticalWeights[i] * (fetch(source, size, x, y, 0, -kVerticalOffsets[i], edges) +
                                    fetch(source, size, x, y, 0, kVerticalOffsets[i], edges));
    return sum;
  });
}

DoubleImage bloom_up(const DoubleImage& low, Size size, bool bicubic, Edges edges) {
  return generate(size, [&](int x, int y) {
    const double px = source_position(x, low.width, size.width), py = source_position(y, low.height, size.height);
    return bicubic ? sample_bspline(low, px, py, edges) : sample_linear(low, px, py, edges);
  });
}

DoubleImage bloom_add(const DoubleImage& up, const DoubleImage& high, double intensity) {
  return combine(up, high, [&](const Rgb& low, const Rgb& h) { return h + intensity * low; });
}

DoubleImage bloom_scatter(const DoubleImage& up, const DoubleImage& high, double amount) {
  return combine(up, high, [&](const Rgb& low, const Rgb& h) { return h + amount * (low - h); });
}

DoubleImage bloom_scatter_final(const DoubleImage& up, const DoubleImage& high, double intensity,
                                const BloomThreshold& threshold) {
  return combine(up, high, [&](const Rgb& low, const Rgb& h) {
    return h + intensity * (low - threshold(held(h, threshold.clamp)));
  });
}

std::vector<Size> bloom_sizes(Size size, int max_iterations, int downscale_limit) {
  Size s = half(size);
  if (max_iterations <= 0 || s.width < 2 * downscale_limit || s.height < 2 * downscale_limit) return {};
  std::vector<Size> sizes{s};
  s = half(s);
  for (int i = 0; i < max_iterations && s.width >= downscale_limit && s.height >= downscale_limit; ++i, s = half(s))
    sizes.push_back(s);
  return sizes;
}

BloomImages bloom(const DoubleImage& source, const BloomSettings& settings) {
  BloomImages out;
  const DoubleImage glowing = map_color(source, [&](const Rgb& c) { return held(c, settings.clamp); });
  const bool resized = settings.reference_height > 0;
  const Size full = resized ? bloom_scaled_size(source.size(), settings.reference_height) : source.size();
  const auto sizes = bloom_sizes(full, settings.max_iterations, settings.downscale_limit);
  if (sizes.empty() || settings.intensity <= 0) {
    out.result = source;
    return out;
  }
  out.ran = true;
  auto threshold = BloomThreshold::from_gamma(settings.threshold, settings.knee);
  threshold.clamp = settings.clamp;
  if (settings.fade_fireflies && full.height > source.height) {
    out.prefilter = bloom_scaled(bloom_fade_fireflies(glowing, source.size(), threshold), sizes.front());
  } else {
    const DoubleImage scaled = resized ? bloom_scaled(glowing, full) : glowing;
    out.prefilter =
        settings.fade_fireflies ? bloom_prefilter_fireflies(scaled, threshold) : bloom_prefilter(scaled, threshold);
  }

  const std::size_t levels = sizes.size() - 1;
  for (std::size_t i = 0; i < levels; ++i) {
    out.horizontal.push_back(bloom_horizontal(i == 0 ? out.prefilter : out.vertical.back(), settings.edges));
    out.vertical.push_back(bloom_vertical(out.horizontal.back(), settings.edges));
  }

  out.up.resize(levels - 1);
  out.combine.resize(levels - 1);
  const DoubleImage* low = &out.vertical.back();
  for (std::size_t i = levels - 1; i-- > 0;) {
    const DoubleImage& high = out.vertical[i];
    out.up[i] = bloom_up(*low, high.size(), settings.bicubic_upsampling, settings.edges);
    out.combine[i] = settings.mode == BloomMode::additive ? bloom_add(out.up[i], high, 1)
                                                          : bloom_scatter(out.up[i], high, settings.scatter);
    low = &out.combine[i];
  }

  out.final_up = bloom_up(*low, source.size(), settings.bicubic_upsampling, settings.edges);
  out.result =
      settings.mode == BloomMode::additive
          ? bloom_add(out.final_up, source, settings.intensity)
          : bloom_scatter_final(out.final_up, source, glm::min(settings.intensity, kScatterIntensityLimit), threshold);
  return out;
}

}  // namespace afterglow::reference
