// SPDX-License-Identifier: MIT
// --size: both sides, one of them, or a share; what pictures are scaled to, and back.
#include <gtest/gtest.h>

#include <cmath>

#include "image/scale.h"

namespace afterglow {
namespace {

Size size_of(const std::string& text, Size picture = {1920, 1080}) { return parse_size_wish(text)->of(picture); }

TEST(SizeWish, KeepsTheShapeUnlessBothSidesAreGiven) {
  EXPECT_EQ(size_of("640x480"), (Size{640, 480}));
  EXPECT_EQ(size_of("640"), (Size{640, 360}));
  EXPECT_EQ(size_of("x720"), (Size{1280, 720}));
  EXPECT_EQ(size_of("640x"), (Size{640, 360}));
  EXPECT_EQ(size_of("50%"), (Size{960, 540}));
  EXPECT_EQ(size_of("33.3%"), (Size{639, 360}));
  EXPECT_EQ(size_of("0.01%"), (Size{1, 1}));
  EXPECT_EQ(size_of("1", {300, 7}), (Size{1, 1}));
}

TEST(SizeWish, RefusesWhatIsNoSize) {
  for (const char* text :
       {"", "x", "0", "0x5", "16385", "1.5", "640x360x2", "-4", "%", "0%", "-5%", "1601%", "5 %", "6y4"}) {
    const auto wish = parse_size_wish(text);
    ASSERT_FALSE(wish.ok()) << text;
    EXPECT_EQ(wish.error().allowed, "WIDTHxHEIGHT, WIDTH, xHEIGHT (1 to 16384) or a share like 50%");
  }
}

Picture ramp(int width, int height) {
  Picture picture;
  picture.color = Image(width, height, 4);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      float* pixel = picture.color.at(x, y);
      pixel[0] = static_cast<float>(x * x + y), pixel[1] = static_cast<float>(y), pixel[2] = 1, pixel[3] = 0.5f;
    }
  picture.data_window = picture.display_window = {0, 0, width, height};
  return picture;
}

/// The mean of red over the area [x0, x1] × [y0, y1] of a picture, by its definition.
double mean_red(const Image& image, double x0, double x1, double y0, double y1) {
  double sum = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const double across = std::max(0.0, std::min(x1, x + 1.0) - std::max<double>(x0, x));
      const double down = std::max(0.0, std::min(y1, y + 1.0) - std::max<double>(y0, y));
      sum += across * down * image.at(x, y)[0];
    }
  return sum / ((x1 - x0) * (y1 - y0));
}

TEST(ScalePicture, MakesEachPixelTheMeanOfItsArea) {
  const Picture source = ramp(9, 7);
  for (const Size size : {Size{3, 7}, Size{4, 3}, Size{9, 7}, Size{1, 1}, Size{8, 5}}) {
    Picture picture = source;
    scale_picture(picture, {size});
    ASSERT_EQ(picture.color.size(), size);
    EXPECT_EQ(picture.data_window, (Rect{0, 0, size.width, size.height}));
    const double across = 9.0 / size.width, down = 7.0 / size.height;
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        const double wanted = mean_red(source.color, x * across, (x + 1) * across, y * down, (y + 1) * down);
        EXPECT_NEAR(picture.color.at(x, y)[0], wanted, 1e-5 * (1 + wanted)) << x << ',' << y;
        EXPECT_NEAR(picture.color.at(x, y)[3], 0.5f, 1e-6f);
      }
  }
}

TEST(ScalePicture, WhatIsOpaqueStaysSo) {
  for (const Size size : {Size{123, 77}, Size{333, 187}, Size{700, 394}, Size{7, 5}}) {
    Picture picture = ramp(320, 180);
    for (std::size_t i = 3; i < picture.color.pixels.size(); i += 4) picture.color.pixels[i] = 1;
    scale_picture(picture, {size});
    for (std::size_t i = 3; i < picture.color.pixels.size(); i += 4) ASSERT_EQ(picture.color.pixels[i], 1);
  }
}

TEST(ScalePicture, InterpolatesWhereItEnlarges) {
  Picture picture = ramp(2, 1);
  scale_picture(picture, {{4, 1}});
  const float wanted[] = {0, 0.25f, 0.75f, 1};
  for (int x = 0; x < 4; ++x) EXPECT_FLOAT_EQ(picture.color.at(x, 0)[0], wanted[x]);
}

TEST(ScalePicture, FinerAndShrunkIsTheSameAsAtOnce) {
  Picture once = ramp(24, 16);
  once.data_window = {-3, 5, 24, 16};
  once.display_window = {-8, 0, 40, 40};
  Picture twice = once;
  scale_picture(once, {{10, 10}});
  scale_picture(twice, {{10, 10}, 2});
  EXPECT_EQ(twice.color.size(), (Size{12, 8}));
  shrink_picture(twice, 2);
  EXPECT_EQ(twice.data_window, once.data_window);
  EXPECT_EQ(twice.display_window, once.display_window);
  ASSERT_EQ(twice.color.size(), once.color.size());
  for (std::size_t i = 0; i < once.color.pixels.size(); ++i)
    EXPECT_NEAR(twice.color.pixels[i], once.color.pixels[i], 1e-5f * (1 + once.color.pixels[i]));
}

}  // namespace
}  // namespace afterglow
