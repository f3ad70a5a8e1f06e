// SPDX-License-Identifier: MIT
// What two pictures have in common: real ones, moved, lit, dissolved, covered and cut.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "core/diagnostics.h"
#include "image/cuts.h"
#include "image/encode.h"
#include "image/reader.h"
#include "image/shot.h"

namespace afterglow {
namespace {

constexpr int kWidth = 480, kHeight = 270;

Image color_of(const std::string& name) {
  Diagnostics ignored;
  auto picture = read_picture(AFTERGLOW_PROJECT_FOLDER "/tests/images/" + name, {}, ignored);
  if (!picture) throw std::runtime_error(picture.error().text());
  return std::move(picture->color);
}

const std::vector<Image>& scenes() {
  static const std::vector<Image> all{color_of("showcase/alley.exr"), color_of("showcase/sea.exr"),
                                      color_of("hdri/sunset.exr"), color_of("ldr/rocket.jpg"), color_of("neon.exr")};
  return all;
}

/// What a camera sees that looks at (x, y) of the scene, 0…1, with a window of `part` of it.
Picture view_of(const Image& scene, double x, double y, double part = 0.5) {
  Picture out;
  out.color = Image(kWidth, kHeight, 4);
  for (int v = 0; v < kHeight; ++v)
    for (int u = 0; u < kWidth; ++u) {
      const double at_x = x + part * ((u + 0.5) / kWidth - 0.5), at_y = y + part * ((v + 0.5) / kHeight - 0.5);
      const int from_x = std::clamp(static_cast<int>(at_x * scene.width), 0, scene.width - 1);
      const int from_y = std::clamp(static_cast<int>(at_y * scene.height), 0, scene.height - 1);
      std::copy_n(scene.at(from_x, from_y), 3, out.color.at(u, v));
      out.color.at(u, v)[3] = 1;
    }
  return out;
}

template <class Change>
Picture changed(Picture picture, Change change) {
  for (int y = 0; y < picture.color.height; ++y)
    for (int x = 0; x < picture.color.width; ++x)
      for (int c = 0; c < 3; ++c) picture.color.at(x, y)[c] = change(picture.color.at(x, y)[c], x, y, c);
  return picture;
}

float mean_of(const Picture& picture) {
  double sum = 0;
  for (const float value : picture.color.pixels) sum += value;
  return static_cast<float>(sum / static_cast<double>(picture.color.pixels.size()));
}

bool follows(const Picture& before, const Picture& now) { return same_shot(sketch_of(before), sketch_of(now)); }

TEST(Shot, OtherScenesAreCuts) {
  for (std::size_t a = 0; a < scenes().size(); ++a)
    for (std::size_t b = 0; b < scenes().size(); ++b)
      for (const double part : {1.0, 0.5}) {
        EXPECT_EQ(follows(view_of(scenes()[a], 0.5, 0.5, part), view_of(scenes()[b], 0.5, 0.5, part)), a == b)
            << a << " to " << b << " at " << part;
      }
}

/// A bright sky over dark ground is what many landscapes have in common.
TEST(Shot, NightIsNotTheDayBefore) {
  const Picture day = view_of(scenes()[2], 0.5, 0.5, 1);
  const auto other_side = [&](float scale) {
    return changed(day, [&](float, int x, int y, int of) { return day.color.at(kWidth - 1 - x, y)[of] / scale; });
  };
  EXPECT_FALSE(follows(day, other_side(8)));
  EXPECT_TRUE(follows(day, changed(day, [](float c, int, int, int) { return c / 8; }))) << "its own night";
}

/// From one camera to another in the same place.
TEST(Shot, OtherCamerasInASceneAreCuts) {
  for (const std::size_t scene : {0, 4})
    for (const double x : {0.25, 0.75})
      EXPECT_FALSE(follows(view_of(scenes()[scene], x, 0.25), view_of(scenes()[scene], 1 - x, 0.75))) << scene;
}

TEST(Shot, CamerasThatMoveAreNoCuts) {
  for (const Image& scene : scenes())
    for (int turn = 0; turn < 8; ++turn) {
      const double angle = turn * 0.7854, far = 0.15 * 0.5;  // 15 % of what is seen, in one frame
      const Picture before = view_of(scene, 0.5, 0.5);
      EXPECT_TRUE(follows(before, view_of(scene, 0.5 + far * std::cos(angle), 0.5 + far * std::sin(angle)))) << turn;
      EXPECT_TRUE(follows(before, view_of(scene, 0.5, 0.5, 0.5 / 1.05))) << "it goes nearer";
    }
}

TEST(Shot, LightThatComesOnIsNoCut) {
  for (const Image& scene : scenes()) {
    const Picture dark = view_of(scene, 0.5, 0.5, 0.9);
    const auto lamp = [](int x, int y) {
      const float u = (static_cast<float>(x) - 150) / 120, v = (static_cast<float>(y) - 100) / 120;
      return std::exp(-u * u - v * v);
    };
    const float mean = mean_of(dark);
    for (const float bright : {1.f, 4.f, 16.f}) {
      const Picture lit = changed(dark, [&](float c, int x, int y, int) { return c * (1 + 8 * bright * lamp(x, y)); });
      EXPECT_TRUE(follows(dark, lit) && follows(lit, dark)) << bright;
      const Picture veiled = changed(dark, [&](float c, int x, int y, int) { return c + mean * bright * lamp(x, y); });
      EXPECT_TRUE(follows(dark, veiled) && follows(veiled, dark)) << bright;
    }
    EXPECT_TRUE(follows(dark, changed(dark, [](float c, int, int, int) { return c * 100; }))) << "all of it";
    EXPECT_TRUE(follows(dark, changed(dark, [](float c, int, int, int of) { return c * (of == 0 ? 3.f : 1.f); })));
  }
}

TEST(Shot, DissolvesNoiseAndWhatEntersAreNoCuts) {
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  for (std::size_t i = 0; i < scenes().size(); ++i) {
    const Picture first = view_of(scenes()[i], 0.5, 0.5);
    const Picture other = view_of(scenes()[(i + 1) % scenes().size()], 0.5, 0.5);
    const float scale = mean_of(first) / mean_of(other);
    Picture before = first;
    for (int step = 1; step <= 6; ++step) {
      const float part = static_cast<float>(step) / 6;
      const Picture mixed = changed(first, [&](float c, int x, int y, int of) {
        return c * (1 - part) + part * scale * other.color.at(x, y)[of];
      });
      EXPECT_TRUE(follows(before, mixed)) << "a dissolve of six frames, step " << step;
      before = mixed;
    }
    const auto noisy = [&] {
      const float much = mean_of(first) / 2;
      return changed(first, [&](float c, int, int, int) { return std::max(c + much * normal(random), 0.f); });
    };
    EXPECT_TRUE(follows(noisy(), noisy()));
    EXPECT_TRUE(
        follows(first, changed(first, [&](float c, int x, int y,
                                          int of) { return x < kWidth / 4 ? scale * other.color.at(x, y)[of] : c; })))
        << "a quarter is covered at once";
  }
}

Picture flat(float value, int width = kWidth, int height = kHeight) {
  Picture picture;
  picture.color = Image(width, height, 4);
  std::ranges::fill(picture.color.pixels, value);
  return picture;
}

/// Flashes, fades, black film with its grain: they are of the shot around them.
TEST(Shot, WhatShowsNothingIsBlank) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> noise;
  const auto grain = [&](float, int, int, int) { return 0.0009f * noise(random); };
  const auto snow = [&](float, int, int, int) { return noise(random); };
  EXPECT_TRUE(sketch_of({}).blank);
  for (const float value : {0.f, 1.f, 1e30f}) EXPECT_TRUE(sketch_of(flat(value)).blank) << value;
  EXPECT_TRUE(sketch_of(flat(1, 1, 1)).blank);
  EXPECT_TRUE(sketch_of(changed(flat(0), grain)).blank);
  EXPECT_TRUE(sketch_of(changed(flat(0), snow)).blank);
  EXPECT_TRUE(sketch_of(changed(flat(1), [](float c, int, int y, int) { return y < 30 || y > 240 ? 0 : c; })).blank)
      << "in a letterbox";
  for (const Image& scene : scenes()) {
    EXPECT_FALSE(sketch_of(view_of(scene, 0.5, 0.5)).blank);
    EXPECT_FALSE(sketch_of(changed(view_of(scene, 0.5, 0.5), [](float c, int, int, int) { return c / 64; })).blank);
  }
}

/// They are the same in all shots, and count for more than what is between them.
TEST(Shot, BarsDoNotCount) {
  const auto boxed = [](Picture picture) {
    return changed(std::move(picture), [](float c, int x, int y, int) {
      return y < kHeight / 8 || y >= kHeight * 7 / 8 || x < 20 ? 0.0001f : c;
    });
  };
  for (std::size_t a = 0; a < scenes().size(); ++a)
    for (std::size_t b = 0; b < scenes().size(); ++b)
      EXPECT_EQ(follows(boxed(view_of(scenes()[a], 0.5, 0.5)), boxed(view_of(scenes()[b], 0.52, 0.52))), a == b)
          << a << " to " << b;
}

TEST(Shot, SparksAreNoPictures) {
  const Picture alley = view_of(scenes()[0], 0.5, 0.5);
  Picture spark = alley, other_spark = alley;
  spark.color.at(20, 30)[1] = other_spark.color.at(400, 200)[0] = 1e30f;
  EXPECT_TRUE(follows(spark, other_spark)) << "pixels out of all bounds";
  EXPECT_TRUE(follows(alley, spark));
}

TEST(Shot, ReadsHalfFloatsAsTheyAre) {
  Picture halves = view_of(scenes()[0], 0.5, 0.5);
  halves.halves.resize(halves.color.pixels.size());
  to_half(halves.color.pixels.data(), halves.halves.data(), halves.halves.size());
  Picture floats = halves;
  open_color(floats);
  halves.color.pixels.clear();
  EXPECT_EQ(sketch_of(halves).tones, sketch_of(floats).tones);
  EXPECT_EQ(sketch_of(halves).details, sketch_of(floats).details);
}

TEST(Cuts, AreToldByNumbers) {
  const auto cuts = parse_cuts("25,9-11");
  ASSERT_TRUE(cuts);
  EXPECT_EQ(cuts->frames, (std::vector<int>{9, 10, 11, 25}));
  EXPECT_FALSE(cuts->looks(true));
  EXPECT_TRUE(cuts->between(8, 9));
  EXPECT_FALSE(cuts->between(11, 24));
  EXPECT_TRUE(cuts->between(11, 30)) << "frames were left out";
  EXPECT_FALSE(cuts->between(25, 26));
  EXPECT_FALSE(cuts->between(26, 25));
  EXPECT_TRUE(parse_cuts("all")->between(1, 2));
  EXPECT_FALSE(parse_cuts("all")->between(2, 1));
  EXPECT_TRUE(parse_cuts("auto")->looks(false));
  EXPECT_FALSE(parse_cuts("none")->looks(true));
  EXPECT_TRUE(Cuts{}.looks(true) && !Cuts{}.looks(false));
  EXPECT_EQ(parse_cuts("some").error().kind, ErrorKind::usage);
}

}  // namespace
}  // namespace afterglow
