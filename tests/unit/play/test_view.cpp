// SPDX-License-Identifier: MIT
// Screen ↔ picture.
#include <gtest/gtest.h>

#include <cmath>

#include "play/view.h"

namespace afterglow {
namespace {

constexpr Size kPicture{1920, 1080}, kWindow{1280, 800};

TEST(View, FitShowsTheWholePictureInTheMiddle) {
  const ViewPlacement p = placement(View{}, kPicture, kWindow);
  EXPECT_DOUBLE_EQ(p.scale, 1280.0 / 1920);
  EXPECT_NEAR(p.origin.x, 0, 1e-9);
  EXPECT_NEAR(p.origin.y, 40, 1e-9);
  EXPECT_DOUBLE_EQ(placement(View{}, {0, 0}, kWindow).scale, 1) << "no picture yet";
}

TEST(View, ThereAndBackAgain) {
  View view;
  zoom_at(view, kPicture, kWindow, {300, 200}, 3.7);
  const ViewPlacement p = placement(view, kPicture, kWindow);
  const Point there = to_picture(p, {17, 600}), back = to_screen(p, there);
  EXPECT_NEAR(back.x, 17, 1e-9);
  EXPECT_NEAR(back.y, 600, 1e-9);
}

TEST(View, ZoomKeepsThePointUnderTheCursor) {
  View view;
  const Point cursor{900, 250};
  const Point before = to_picture(placement(view, kPicture, kWindow), cursor);
  for (const double factor : {1.25, 1.25, 0.8, 3.0}) {
    zoom_at(view, kPicture, kWindow, cursor, factor);
    const Point after = to_picture(placement(view, kPicture, kWindow), cursor);
    EXPECT_NEAR(after.x, before.x, 1e-6);
    EXPECT_NEAR(after.y, before.y, 1e-6);
  }
  EXPECT_FALSE(view.fit);
  zoom_at(view, kPicture, kWindow, cursor, 1e9);
  EXPECT_EQ(view.zoom, kMostZoom);
}

TEST(View, OneToOneLiesOnWholePixels) {
  View view;
  one_to_one(view, {333, 111}, {1000, 700});
  const ViewPlacement p = placement(view, {333, 111}, {1000, 700});
  EXPECT_EQ(p.scale, 1);
  EXPECT_EQ(p.origin.x, ::round(p.origin.x));
  EXPECT_EQ(p.origin.y, ::round(p.origin.y));
}

TEST(View, PixelsAreThoseUnderThePoint) {
  View view;
  view.fit = false;
  view.zoom = 4;
  view.center = {0, 0};  // the picture's corner in the middle of the window
  EXPECT_EQ(pixel_at(view, kPicture, kWindow, {640, 400}), (Pixel{0, 0}));
  EXPECT_EQ(pixel_at(view, kPicture, kWindow, {643.9, 404}), (Pixel{0, 1}));
  EXPECT_EQ(pixel_at(view, kPicture, kWindow, {639, 400}), std::nullopt);
}

TEST(View, PanMovesWithTheHandAndKeepsThePictureInReach) {
  View view;
  one_to_one(view, kPicture, kWindow);
  const Point before = to_screen(placement(view, kPicture, kWindow), {500, 500});
  pan(view, kPicture, kWindow, {30, -20});
  const Point after = to_screen(placement(view, kPicture, kWindow), {500, 500});
  EXPECT_NEAR(after.x - before.x, 30, 1e-9);
  EXPECT_NEAR(after.y - before.y, -20, 1e-9);
  pan(view, kPicture, kWindow, {1e6, 1e6});
  EXPECT_EQ(view.center, (Point{0, 0}));
}

TEST(View, WipeFollowsThePointOverThePicture) {
  View view;
  wipe_to(view, kPicture, kWindow, {320, 400});
  EXPECT_DOUBLE_EQ(view.wipe, 0.25);
  wipe_to(view, kPicture, kWindow, {-50, 400});
  EXPECT_EQ(view.wipe, 0);
  view.wipe_vertical = true;
  wipe_to(view, kPicture, kWindow, {320, 400});
  EXPECT_NEAR(view.wipe, 0.5, 1e-9);
}

TEST(View, HalfOfTheWindowIsForEachOfTwoSideBySide) {
  View view;
  view.by = CompareBy::side_by_side;
  EXPECT_EQ(picture_window(view, {901, 500}), (Size{901, 500})) << "nothing is compared";
  view.compare = Compare::source;
  EXPECT_EQ(picture_window(view, {901, 500}), (Size{450, 500}));
  EXPECT_FALSE(wipes(view));
  view.by = CompareBy::wipe;
  EXPECT_TRUE(wipes(view));
  EXPECT_EQ(picture_window(view, {901, 500}), (Size{901, 500}));
}

TEST(View, AFormIsTheLargestInTheMiddle) {
  for (const Aspect& aspect : kAspects) {
    const PictureArea area = area_of_aspect(kPicture, aspect.ratio);
    const double width = area.to.x - area.from.x, height = area.to.y - area.from.y;
    EXPECT_NEAR(width / height, aspect.ratio > 0 ? aspect.ratio : 1920.0 / 1080, 1e-12) << aspect.name;
    EXPECT_TRUE(std::abs(width - 1920) < 1e-9 || std::abs(height - 1080) < 1e-9) << aspect.name << ": could be larger";
    EXPECT_NEAR(area.from.x + area.to.x, 1920, 1e-9) << aspect.name;
    EXPECT_NEAR(area.from.y + area.to.y, 1080, 1e-9) << aspect.name;
    EXPECT_GE(area.from.x, -1e-9);
    EXPECT_GE(area.from.y, -1e-9);
  }
  const PictureArea titles = middle_part(area_of_aspect(kPicture, 0), 0.9);
  EXPECT_NEAR(titles.from.x, 96, 1e-9);
  EXPECT_NEAR(titles.to.x, 1824, 1e-9);
  EXPECT_NEAR(titles.from.y, 54, 1e-9);
  EXPECT_NEAR(titles.to.y, 1026, 1e-9);
}

TEST(View, RegionsAreThePixelsBetweenTwoPoints) {
  const Size picture{100, 50}, window{400, 200};
  View view;  // fitted: four pixels of the screen for each
  EXPECT_EQ(region_between(view, picture, window, {41, 22}, {79, 61}), (Rect{10, 5, 10, 11}));
  EXPECT_EQ(region_between(view, picture, window, {79, 22}, {41, 61}), (Rect{10, 5, 10, 11})) << "any way around";
  EXPECT_EQ(region_between(view, picture, window, {41, 22}, {41, 22}), (Rect{10, 5, 1, 1}));
  EXPECT_EQ(region_between(view, picture, window, {-90, -90}, {4000, 4000}), (Rect{0, 0, 100, 50}));
  view.fit = false;
  view.zoom = 1;
  view.center = {50, 25};
  EXPECT_EQ(region_between(view, picture, window, {0, 0}, {20, 20}), std::nullopt) << "beside the picture";
}

}  // namespace
}  // namespace afterglow
