// SPDX-License-Identifier: MIT
#include "image/scale.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "image/metadata.h"

namespace afterglow {
namespace {

int scaled(int value, int from, int to) {
  return static_cast<int>(std::lround(static_cast<double>(value) * to / from));
}

/// Source texels and weights of one target coordinate.
struct Taps {
  int first = 0;
  std::vector<float> weights;
};

/// Below the source's size the share that each texel has in the target pixel's area; above it, interpolation between
/// two.
std::vector<Taps> area_taps(int source, int target) {
  std::vector<Taps> all(static_cast<std::size_t>(target));
  const double ratio = static_cast<double>(source) / target, radius = std::max(1.0, ratio) / 2;
  for (int i = 0; i < target; ++i) {
    const double center = (i + 0.5) * ratio;
    const double from = std::max(0.0, center - radius), to = std::min<double>(source, center + radius);
    Taps& taps = all[static_cast<std::size_t>(i)];
    taps.first = static_cast<int>(from);
    for (int texel = taps.first; texel < to; ++texel)
      taps.weights.push_back(
          static_cast<float>((std::min(to, texel + 1.0) - std::max<double>(from, texel)) / (to - from)));
  }
  return all;
}

Image resample_rows(const Image& source, int width) {
  const auto taps = area_taps(source.width, width);
  Image out(width, source.height, source.channels);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < width; ++x) {
      const Taps& t = taps[static_cast<std::size_t>(x)];
      for (int c = 0; c < out.channels; ++c) {
        float sum = 0;
        for (std::size_t k = 0; k < t.weights.size(); ++k)
          sum += t.weights[k] * source.at(t.first + static_cast<int>(k), y)[c];
        out.at(x, y)[c] = sum;
      }
    }
  return out;
}

Image resample_columns(const Image& source, int height) {
  const auto taps = area_taps(source.height, height);
  Image out(source.width, height, source.channels);
  const int values = source.width * source.channels;
  for (int y = 0; y < height; ++y) {
    const Taps& t = taps[static_cast<std::size_t>(y)];
    float* row = out.at(0, y);
    for (std::size_t k = 0; k < t.weights.size(); ++k) {
      const float* from = source.at(0, t.first + static_cast<int>(k));
      for (int i = 0; i < values; ++i) row[i] += t.weights[k] * from[i];
    }
  }
  return out;
}

bool is_opaque(const Image& image) {
  if (image.channels != 4) return false;
  for (std::size_t i = 3; i < image.pixels.size(); i += 4)
    if (image.pixels[i] != 1) return false;
  return true;
}

/// Weights add up to 1 but for rounding: what is opaque stays so.
Image resample(const Image& source, Size size) {
  Image out = resample_columns(resample_rows(source, size.width), size.height);
  if (is_opaque(source))
    for (std::size_t i = 3; i < out.pixels.size(); i += 4) out.pixels[i] = 1;
  return out;
}

Image nearest(const Image& source, Size size) {
  Image out(size.width, size.height, source.channels);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const int sx = static_cast<int>((x + 0.5) * source.width / size.width);
      const int sy = static_cast<int>((y + 0.5) * source.height / size.height);
      std::copy_n(source.at(std::min(sx, source.width - 1), std::min(sy, source.height - 1)), source.channels,
                  out.at(x, y));
    }
  return out;
}

Rect times(const Rect& rect, int factor) {
  return {rect.x * factor, rect.y * factor, rect.width * factor, rect.height * factor};
}

/// What the new shape makes of that of the pixels, unless it is but rounded.
void note_shape(Picture& picture, Size now) {
  const Rect& old = picture.display_window;
  const double across = static_cast<double>(now.width) / old.width, down = static_cast<double>(now.height) / old.height;
  const double rounding = 1.0 / now.width + 1.0 / now.height;
  if (!picture.facts || std::abs(across / down - 1) <= rounding) return;
  auto facts = std::make_shared<FileFacts>(*picture.facts);
  facts->widened *= down / across;
  picture.facts = std::move(facts);
}

}  // namespace

Size SizeWish::of(Size display) const {
  const auto side = [](double length) { return static_cast<int>(std::clamp(std::round(length), 1.0, 16384.0)); };
  if (width > 0 && height > 0) return {width, height};
  const double scale = width > 0    ? static_cast<double>(width) / display.width
                       : height > 0 ? static_cast<double>(height) / display.height
                                    : share;
  return {width > 0 ? width : side(display.width * scale), height > 0 ? height : side(display.height * scale)};
}

bool SizeWish::reshapes(Size display) const {
  if (width == 0 || height == 0) return false;
  constexpr double kRounding = 1.5;
  const double shape = static_cast<double>(display.width) / display.height;
  return std::abs(height * shape - width) > kRounding && std::abs(width / shape - height) > kRounding;
}

Result<SizeWish> parse_size_wish(const std::string& text) {
  const auto whole = [](std::string_view part, int& out) {
    if (part.empty()) return true;
    const auto [end, ec] = std::from_chars(part.data(), part.data() + part.size(), out);
    return ec == std::errc() && end == part.data() + part.size() && out >= 1 && out <= 16384;
  };
  SizeWish wish;
  bool good = false;
  if (text.ends_with('%')) {
    const char* end = text.data() + text.size() - 1;
    const auto [stop, ec] = std::from_chars(text.data(), end, wish.share);
    wish.share /= 100;
    good = ec == std::errc() && stop == end && wish.share > 0 && wish.share <= 16;
  } else {
    const std::size_t x = text.find_first_of("xX");
    const std::string_view all = text;
    good = whole(all.substr(0, x), wish.width) && (x == std::string::npos || whole(all.substr(x + 1), wish.height)) &&
           (wish.width > 0 || wish.height > 0);
  }
  if (good) return wish;
  return Error{ErrorKind::usage, "'" + text + "' is no size", "--size", 0,
               "WIDTHxHEIGHT, WIDTH, xHEIGHT (1 to 16384) or a share like 50%"};
}

Size scaled_size(Size data, Size display, Size target) {
  return {std::max(1, scaled(data.width, display.width, target.width)),
          std::max(1, scaled(data.height, display.height, target.height))};
}

Rect scaled_window(const Rect& data, const Rect& display, Size target) {
  const Size size = scaled_size(data.size(), display.size(), target);
  return {display.x + scaled(data.x - display.x, display.width, target.width),
          display.y + scaled(data.y - display.y, display.height, target.height), size.width, size.height};
}

void scale_picture(Picture& picture, const Scaling& scaling) {
  const Rect data = times(scaled_window(picture.data_window, picture.display_window, scaling.display), scaling.finer);
  const Size size = data.size();
  picture.color = resample(picture.color, size);
  const float across = static_cast<float>(size.width) / static_cast<float>(picture.data_window.width),
              down = static_cast<float>(size.height) / static_cast<float>(picture.data_window.height);
  for (auto& [name, image] : picture.auxiliary) {
    image = nearest(image, size);
    if (name != "motion") continue;  // its values are pixels
    for (std::size_t i = 0; i < image.pixels.size(); i += 2) image.pixels[i] *= across, image.pixels[i + 1] *= down;
  }
  const Rect old = picture.display_window;
  note_shape(picture, scaling.display);
  picture.data_window = data;
  picture.display_window = times({old.x, old.y, scaling.display.width, scaling.display.height}, scaling.finer);
}

void shrink_picture(Picture& picture, int finer) {
  if (finer == 1) return;
  const Image& color = picture.color;
  picture.color = resample(color, {color.width / finer, color.height / finer});
  for (Rect* window : {&picture.data_window, &picture.display_window})
    *window = {window->x / finer, window->y / finer, window->width / finer, window->height / finer};
}

}  // namespace afterglow
