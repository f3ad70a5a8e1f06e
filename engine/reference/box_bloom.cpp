// SPDX-License-Identifier: MIT
#include "reference/box_bloom.h"

namespace afterglow::reference {

Rgb box_bloom_threshold(const Rgb& c, double threshold, BoxBrightness brightness) {
  const double b =
      brightness == BoxBrightness::max ? glm::max(c.r, glm::max(c.g, c.b)) : 0.3 * c.r + 0.59 * c.g + 0.11 * c.b;
  return c * (glm::max(0.0, b - threshold) / glm::max(b, 1e-5));
}

DoubleImage box_bloom_blur(const DoubleImage& source, Size size, BoxPattern pattern) {
  static constexpr int kPlus[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  static constexpr int kBox[4][2] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
  const auto& offsets = pattern == BoxPattern::plus ? kPlus : kBox;
  return generate(size, [&](int x, int y) {
    const double px = source_position(x, source.width, size.width), py = source_position(y, source.height, size.height);
    Rgba sum(0);
    for (const auto& o : offsets) sum += 0.25 * sample_linear(source, px + o[0], py + o[1]);
    return sum;
  });
}

namespace {

/// high + low on colours; alpha of high.
DoubleImage add(const DoubleImage& low, const DoubleImage& high) {
  return generate(high.size(), [&](int x, int y) {
    const Rgba& h = high.at(x, y);
    return Rgba(Rgb(h) + Rgb(low.at(x, y)), h.a);
  });
}

}  // namespace

BoxBloomImages box_bloom(const DoubleImage& source, const BoxBloomSettings& settings) {
  BoxBloomImages out;
  out.down.push_back(
      map_color(source, [&](const Rgb& c) { return box_bloom_threshold(c, settings.threshold, settings.brightness); }));
  for (int i = 1; i < settings.blur_iterations; ++i) {
    const Size size{out.down.back().width / 2, out.down.back().height / 2};
    if (size.width == 0 || size.height == 0) break;
    out.down.push_back(box_bloom_blur(out.down.back(), size, settings.pattern));
  }

  const std::size_t n = out.down.size();
  out.blur_up.resize(n);
  out.up.resize(n);
  const DoubleImage* low = &out.down.back();
  for (std::size_t i = n >= 2 ? n - 2 : 0; i >= 1; --i) {
    out.blur_up[i] = box_bloom_blur(*low, out.down[i].size(), settings.pattern);
    out.up[i] = add(out.blur_up[i], out.down[i]);
    low = &out.up[i];
  }
  out.final_up = generate(source.size(), [&](int x, int y) {
    return sample_linear(*low, source_position(x, low->width, source.width),
                         source_position(y, low->height, source.height));
  });
  out.result = add(out.final_up, source);
  return out;
}

}  // namespace afterglow::reference
