// SPDX-License-Identifier: MIT
#include "stress/pictures.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/half.h"
#include "stress/auxiliary.h"
#include "stress/picture_file.h"

namespace afterglow::stress {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

template <class F>
void each_pixel(Image& image, F&& f) {
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) f(x, y, image.at(x, y));
}

void set(float* pixel, float r, float g, float b, float a = 1) {
  pixel[0] = r;
  pixel[1] = g;
  pixel[2] = b;
  pixel[3] = a;
}
void set(float* pixel, double grey, float a = 1) {
  const auto v = static_cast<float>(grey);
  set(pixel, v, v, v, a);
}

float half_value(std::size_t index) { return float_from_half(static_cast<std::uint16_t>(index)); }

/// All 65536 values of a half float, from a place that the seed chooses: 256x256 pixels hold each of them.
void fill_halves(Image& image, Random& random) {
  std::size_t next = random.below(65536);
  each_pixel(image, [&](int, int, float* p) {
    set(p, half_value(next), half_value(next ^ 0x8001), half_value(next * 40503), half_value(next + 0x3c00));
    next = (next + 1) & 0xffff;
  });
}

void fill_extremes(Image& image, Random& random) {
  static const std::vector<float> kValues{0.0f,
                                          -0.0f,
                                          1e30f,
                                          65504.0f,
                                          65505.0f,
                                          65520.0f,
                                          1e4f,
                                          1e-38f,
                                          1e-45f,
                                          6.1e-5f,
                                          5.96e-8f,
                                          1.0f,
                                          60.0f,
                                          3.0e38f,
                                          1e20f,
                                          kInfinity,
                                          -kInfinity,
                                          kNaN,
                                          -1e30f,
                                          -1.0f,
                                          0.18f,
                                          1e-10f,
                                          65536.0f,
                                          8.0e-46f,
                                          std::nextafter(1.0f, 0.0f),
                                          std::nextafter(1.0f, 2.0f)};
  each_pixel(image, [&](int, int, float* p) {
    set(p, random.pick(kValues), random.pick(kValues), random.pick(kValues), random.pick(kValues));
  });
}

/// As extremes, without what reading takes out.
void fill_largest(Image& image, Random& random) {
  static const std::vector<float> kValues{0.0f, 1e30f, 1e30f, 65504.0f, 3e29f, 1e20f, 1e-38f, 1.0f};
  each_pixel(image, [&](int, int, float* p) {
    set(p, random.pick(kValues), random.pick(kValues), random.pick(kValues), static_cast<float>(random.unit()));
  });
}

/// One pixel at 1e6; the seed goes through all places of the pyramid's grid.
void fill_spike(Image& image, Random& random) {
  each_pixel(image, [](int, int, float* p) { set(p, 0); });
  const int x = random.between(0, image.width - 1), y = random.between(0, image.height - 1);
  set(image.at(x, y), 1e6);
}

void fill_fireflies(Image& image, Random& random) {
  each_pixel(image, [&](int, int, float* p) {
    set(p, random.log_between(0.01, 0.5));
    if (random.chance(0.02)) p[random.below(3)] = 1e4f;
  });
}

void fill_checkerboard(Image& image, Random& random) {
  const int period = 1 << random.below(4);
  const double bright = random.chance(0.5) ? 1 : 1000;
  each_pixel(image, [&](int x, int y, float* p) { set(p, (x / period + y / period) % 2 ? bright : 0); });
}

void fill_steps(Image& image, Random& random) {
  const int at = random.between(0, image.width - 1), below = random.between(0, image.height - 1);
  const double low = random.log_between(1e-4, 1), high = random.log_between(0.5, 1e4);
  each_pixel(image, [&](int x, int y, float* p) { set(p, (x < at) != (y < below) ? low : high); });
}

/// Lines a pixel wide, shallow and steep, that no level of a pyramid meets twice alike.
void fill_diagonals(Image& image, Random& random) {
  const double slope = random.between(0.05, 3.0), spacing = random.between(3.0, 40.0);
  const double light = random.chance(0.5) ? 2 : 200;
  each_pixel(image, [&](int x, int y, float* p) {
    const double along = std::fmod(x * slope + y + 1000 * spacing, spacing);
    set(p, along < std::max(1.0, slope) ? light : 0.05);
  });
}

/// Less than one step of 8 bits over the whole picture.
void fill_gradient(Image& image, Random& random) {
  const double level = random.between(0.05, 1.2);
  each_pixel(image, [&](int x, int y, float* p) {
    const double t = static_cast<double>(x + y) / (image.width + image.height);
    set(p, static_cast<float>(level + t / 255), static_cast<float>(level * 0.9 + t / 300), static_cast<float>(level));
  });
}

void fill_log_uniform(Image& image, Random& random) {
  each_pixel(image, [&](int, int, float* p) {
    for (int c = 0; c < 3; ++c) p[c] = static_cast<float>(random.log_between(1e-5, 1e4));
    p[3] = static_cast<float>(random.unit());
  });
}

/// Light as renders have it.
void fill_render(Image& image, Random& random) {
  each_pixel(image, [&](int, int, float* p) {
    // The sum of twelve uniform numbers is near enough to a normal one.
    double normal = -6;
    for (int i = 0; i < 12; ++i) normal += random.unit();
    const double light = std::min(std::exp(-1.2 + 1.4 * normal), 43.0);
    for (int c = 0; c < 3; ++c) p[c] = static_cast<float>(light * (0.15 + 0.85 * random.unit()));
    p[3] = 1;
  });
}

/// What is left after tone mapping.
void fill_display(Image& image, Random& random) {
  each_pixel(image, [&](int, int, float* p) {
    for (int c = 0; c < 3; ++c) p[c] = static_cast<float>(random.unit());
    p[3] = 1;
  });
}

/// Around 1, where thresholds begin: steps of a few halves.
void fill_threshold(Image& image, Random& random) {
  const double around = random.chance(0.5) ? 1 : random.log_between(0.2, 10);
  each_pixel(image, [&](int, int, float* p) {
    for (int c = 0; c < 3; ++c) p[c] = static_cast<float>(around * (1 + random.between(-4, 4) / 1024.0));
    p[3] = 1;
  });
}

void fill_empty_alpha(Image& image, Random& random) {
  each_pixel(image, [&](int x, int y, float* p) {
    set(p, static_cast<float>(random.unit()), static_cast<float>(random.unit() * 4), 0.25f,
        (x / 3 + y / 3) % 2 ? 0.0f : 1.0f);
  });
}

void fill_constant(Image& image, Random& random) {
  float value[3];
  for (float& v : value) v = static_cast<float>(random.log_between(1e-3, 1e3));
  each_pixel(image, [&](int, int, float* p) { set(p, value[0], value[1], value[2]); });
}

void fill_black(Image& image, Random&) {
  each_pixel(image, [](int, int, float* p) { set(p, 0, 0); });
}

void fill_greys(Image& image, Random& random) {
  const double top = random.log_between(0.5, 100);
  const double count = std::max(1, image.width * image.height - 1);
  each_pixel(image, [&](int x, int y, float* p) { set(p, top * (y * image.width + x) / count); });
}

constexpr PictureKind kKinds[] = {
    {"render", "log-normal light up to 43, as renders have it", fill_render, true},
    {"display", "noise from 0 to 1", fill_display, true},
    {"halves", "all 65536 values of a half float, NaN, infinities and denormals too", fill_halves, false},
    {"fireflies", "single pixels at 1e4 in a dark picture", fill_fireflies, true},
    {"extremes", "±0, denormals, 65504, 1e30, 3e38, infinities, NaN", fill_extremes, false},
    {"log_uniform", "every power of ten from 1e-5 to 1e4", fill_log_uniform, true},
    {"spike", "one pixel at 1e6 in black", fill_spike, true},
    {"checkerboard", "squares of 1 to 8 pixels", fill_checkerboard, true},
    {"steps", "straight edges from dark to 1e4", fill_steps, true},
    {"diagonals", "lines a pixel wide", fill_diagonals, true},
    {"gradient", "less than one 8-bit step from corner to corner", fill_gradient, true},
    {"threshold", "values around 1, a few roundings apart", fill_threshold, true},
    {"largest", "0, 1e-38 and up to 1e30 side by side", fill_largest, false},
    {"empty_alpha", "light where alpha is 0", fill_empty_alpha, true},
    {"constant", "one colour", fill_constant, true},
    {"greys", "a ramp of greys", fill_greys, true},
    {"black", "black, alpha 0", fill_black, true},
};

}  // namespace

std::span<const PictureKind> picture_kinds() { return kKinds; }

const PictureKind* find_picture_kind(const std::string& name) {
  const auto found = std::ranges::find(kKinds, name, &PictureKind::name);
  return found == std::end(kKinds) ? nullptr : &*found;
}

void round_to_halves(Image& rgba) {
  std::vector<std::uint16_t> halves(rgba.pixels.size());
  halves_from_floats(rgba.pixels.data(), halves.size(), halves.data());
  floats_from_halves(halves.data(), halves.size(), rgba.pixels.data());
}

Picture make_picture(const PictureSpec& spec) {
  const PictureKind& kind = *find_picture_kind(spec.kind);
  Picture out;
  out.color = Image(spec.size.width, spec.size.height, 4);
  Random random(spec.seed, hash_text(spec.kind).low);
  kind.fill(out.color, random);
  if (kind.gentle && *std::ranges::max_element(out.color.pixels) <= kMaxHalf) round_to_halves(out.color);
  add_auxiliary(out, random, kind.gentle);
  out.has_alpha = true;
  out.data_window = out.display_window = {0, 0, spec.size.width, spec.size.height};
  return out;
}

Result<Picture> as_read(const Picture& picture, const std::filesystem::path& folder, Diagnostics& diagnostics) {
  const auto file = folder / "input.exr";
  AFTERGLOW_CHECK(write_picture_file(picture, file));
  return read_picture_file(file, diagnostics);
}

Image cropped(const Image& image, const Rect& part) {
  Image out(part.width, part.height, image.channels);
  for (int y = 0; y < part.height; ++y)
    std::copy_n(image.at(part.x, part.y + y), static_cast<std::ptrdiff_t>(part.width) * image.channels, out.at(0, y));
  return out;
}

}  // namespace afterglow::stress
