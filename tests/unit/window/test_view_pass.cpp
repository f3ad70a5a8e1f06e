// SPDX-License-Identifier: MIT
// The view on lavapipe against the same mathematics in double precision.
#include "view_pass_test.h"

namespace afterglow {
namespace {

const Size kPicture{23, 17};

ViewFrame frame_of(Rect area, View view) {
  ViewFrame frame;
  frame.picture = kPicture;
  frame.area = area;
  frame.view = view;
  return frame;
}

TEST_F(ViewPassTest, PlacesMagnifiesAndMinifies) {
  const Image image = picture(kPicture, 1);
  const Rect area{5, 3, 61, 47};
  expect_same(frame_of(area, {}), image, nullptr, {70, 55}, "fit");
  for (const double zoom : {0.125, 0.23, 0.5, 0.81, 1.0, 1.37, 2.0, 3.0, 7.7, 16.0}) {
    // Centres off the grid, so that no pixel's middle lies on the border of two of the picture's.
    const View view{.fit = false, .zoom = zoom, .center = {11.213, 8.347}};
    expect_same(frame_of(area, view), image, nullptr, {70, 55}, std::to_string(zoom).c_str());
  }
}

TEST_F(ViewPassTest, TheProcessorMakesTheSameCodes) {
  const Image image = picture(kPicture, 1), before = picture(kPicture, 5), small = picture({15, 13}, 6);
  for (const VkFormat format : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM})
    for (const bool half : {false, true})
      for (const double zoom : {0.125, 0.23, 0.5, 0.81, 1.0, 1.37, 3.0, 7.7, 16.0}) {
        SCOPED_TRACE(std::to_string(format) + (half ? ", halves, " : ", floats, ") + std::to_string(zoom));
        View view{.fit = false, .zoom = zoom, .center = {11.213, 8.347}, .exposure = half ? 0 : 1.5};
        expect_codes(frame_of({0, 0, 61, 47}, view), image, nullptr, {61, 47}, format, half, true);
        view.compare = Compare::source;
        view.wipe = 0.413;
        view.wipe_vertical = half;
        expect_codes(frame_of({0, 0, 61, 47}, view), small, &before, {61, 47}, format, half, true);
      }
}

TEST_F(ViewPassTest, TheProcessorLeavesOtherWaysToTheShader) {
  const Image image = picture(kPicture, 1), before = picture(kPicture, 5);
  const auto shader_draws = [&](const View& view, ViewBackground background = ViewBackground::none) {
    ViewFrame frame = frame_of({0, 0, 61, 47}, view);
    frame.background = background;
    expect_codes(frame, image, &before, {61, 47}, VK_FORMAT_B8G8R8A8_UNORM, false, false);
  };
  shader_draws({.smooth = true});
  shader_draws({.channel = ViewChannel::green});
  shader_draws({.marks = Marks::range});
  shader_draws({}, ViewBackground::checker);
  View view;
  view.gamma = 1.8;
  shader_draws(view);
  view = {};
  view.compare = Compare::other;
  view.by = CompareBy::difference;
  shader_draws(view);
}

TEST_F(ViewPassTest, MagnifiesSmoothly) {
  const Image image = picture(kPicture, 1);
  for (const double zoom : {0.5, 1.0, 1.37, 7.7, 16.0}) {
    const View view{.fit = false, .zoom = zoom, .center = {11.213, 8.347}, .smooth = true};
    expect_same(frame_of({5, 3, 61, 47}, view), image, nullptr, {70, 55}, std::to_string(zoom).c_str());
  }
}

TEST_F(ViewPassTest, AtOneToOneEveryPixelIsThePictures) {
  const Image image = picture(kPicture, 2);
  View view;
  one_to_one(view, kPicture, {23, 17});
  expect_same(frame_of({0, 0, 23, 17}, view), image, nullptr, {23, 17}, "1:1");
}

TEST_F(ViewPassTest, ChannelsExposureAndBackgrounds) {
  const Image image = picture(kPicture, 3);
  for (const auto channel : {ViewChannel::color, ViewChannel::red, ViewChannel::green, ViewChannel::blue,
                             ViewChannel::alpha, ViewChannel::luminance}) {
    for (const double exposure : {0.0, -2.5, 1.75}) {
      for (const Marks marks : {Marks::none, Marks::range, Marks::stops}) {
        for (const double zoom : {0.4, 2.0}) {
          View view{.fit = false, .zoom = zoom, .center = {11.213, 8.347}};
          view.exposure = exposure;
          view.channel = channel;
          view.marks = marks;
          view.gamma = zoom < 1 ? 1.8 : 0.6;
          expect_same(frame_of({0, 0, 48, 36}, view), image, nullptr, {48, 36},
                      (view_channel_name(channel) + ", marks: " + marks_name(marks)).c_str());
        }
      }
    }
  }
  for (const auto background : {ViewBackground::gray, ViewBackground::checker}) {
    ViewFrame frame = frame_of({0, 0, 48, 36}, {});
    frame.background = background;
    frame.pixel_scale = 1.5f;
    expect_same(frame, image, nullptr, {48, 36}, "background");
  }
}

TEST_F(ViewPassTest, FalseColorFindsOneBadPixelAtAnyZoom) {
  Image image(64, 64, 4);
  std::fill(image.pixels.begin(), image.pixels.end(), 0.5f);
  image.at(37, 21)[1] = std::numeric_limits<float>::quiet_NaN();
  View view{.fit = false, .zoom = 1.0 / 32, .center = {32, 32}, .marks = Marks::range};
  ViewFrame frame = frame_of({0, 0, 2, 2}, view);
  frame.picture = {64, 64};
  const GpuImage gpu = upload(image);
  frame.shown = {gpu.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, image.size()};
  const Image drawn = draw(frame, {2, 2}, {gpu.get()});
  EXPECT_NEAR(drawn.at(1, 0)[0], kMarkNotFinite[0], 1e-3);
  EXPECT_NEAR(drawn.at(1, 0)[1], kMarkNotFinite[1], 1e-3);
  EXPECT_NEAR(drawn.at(0, 0)[0], drawn.at(0, 0)[1], 1e-6);  // grey: nothing is marked here
  EXPECT_GT(drawn.at(0, 0)[0], 0.5f);
}

/// A quarter of a stop above and below each zone's own: both are of its colour.
TEST_F(ViewPassTest, EveryStopHasItsZone) {
  const int zones = static_cast<int>(kZones.size());
  Image image(zones, 2, 4);
  for (int zone = 0; zone < zones; ++zone) {
    for (int y = 0; y < 2; ++y) {
      float* c = image.at(zone, y);
      std::fill(c, c + 3, 0.18f * std::exp2(static_cast<float>(kFirstZone + zone) + (y == 0 ? 0.25f : -0.25f)));
      c[3] = 1;
    }
  }
  View view;
  view.marks = Marks::stops;
  view.gamma = 2.2;  // zones are of the light
  one_to_one(view, image.size(), image.size());
  ViewFrame frame = frame_of({0, 0, zones, 2}, view);
  frame.picture = image.size();
  const GpuImage gpu = upload(image);
  frame.shown = {gpu.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, image.size()};
  const Image drawn = draw(frame, image.size(), {gpu.get()});
  for (int zone = 0; zone < zones; ++zone)
    for (int y = 0; y < 2; ++y)
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(drawn.at(zone, y)[c], kZones[static_cast<std::size_t>(zone)][c], 1e-3) << kFirstZone + zone;
}

TEST_F(ViewPassTest, WipesBetweenImagesOfAnySize) {
  const Image after = picture(kPicture, 4), before = picture(kPicture, 5), small = picture({15, 13}, 6);
  for (const bool vertical : {false, true}) {
    for (const double zoom : {0.6, 3.0}) {
      View view{.fit = false, .zoom = zoom, .center = {11.213, 8.347}};
      view.compare = Compare::source;
      view.wipe = 0.413;
      view.wipe_vertical = vertical;
      expect_same(frame_of({4, 2, 48, 36}, view), after, &before, {56, 40}, "same size");
      expect_same(frame_of({4, 2, 48, 36}, view), small, &before, {56, 40}, "smaller result");
      expect_same(frame_of({4, 2, 48, 36}, view), after, nullptr, {56, 40}, "nothing to compare with");
    }
  }
}

TEST_F(ViewPassTest, ShowsHowFarTwoImagesAreApart) {
  const Image after = picture(kPicture, 4), before = picture(kPicture, 5);
  for (const ViewChannel channel : {ViewChannel::color, ViewChannel::green, ViewChannel::luminance}) {
    View view{.fit = false, .zoom = 3, .center = {11.213, 8.347}, .exposure = 1.5, .channel = channel};
    view.compare = Compare::other;
    view.by = CompareBy::difference;
    expect_same(frame_of({4, 2, 48, 36}, view), after, &before, {56, 40}, "difference");
  }
}

/// A small table with a shaper of its own, whose codes lie beyond 0…1 too: what is read in it shows at once.
DisplayTable odd_table() {
  DisplayTable out{.name = "odd", .planes = 11, .zero = 3, .bend = 2, .cells = 3, .cells_below = 4};
  out.size = {out.planes * kDisplayTiles, out.planes * 2};
  std::mt19937 random(5);
  std::uniform_real_distribution<float> noise(-0.2f, 1.2f);
  for (long long i = 0; i < out.size.area() * 4; ++i) out.codes.push_back(noise(random));
  return out;
}

TEST_F(ViewPassTest, LightIsShownAsTheDisplayHasIt) {
  const DisplayTable table = odd_table();
  Image image = picture({40, 30}, 7), other = picture({40, 30}, 8);
  std::mt19937 random(9);
  std::uniform_real_distribution<float> wide(-0.6f, 4);
  for (std::size_t i = 0; i < 600; ++i) image.pixels[i * 4 + i % 3] = wide(random);
  for (float* equal : {image.at(5, 5), image.at(6, 5)}) equal[0] = equal[1] = equal[2] = 0.3f;
  display_ = &table;
  for (const auto channel : {ViewChannel::color, ViewChannel::green, ViewChannel::alpha, ViewChannel::luminance})
    for (const Marks marks : {Marks::none, Marks::range, Marks::stops})
      for (const bool as_display : {true, false}) {
        View view;
        one_to_one(view, image.size(), image.size());
        view.channel = channel;
        view.marks = marks;
        view.exposure = 0.5;
        view.as_display = as_display;
        ViewFrame frame = frame_of({0, 0, 40, 30}, view);
        frame.picture = image.size();
        expect_same(frame, image, nullptr, {40, 30}, (view_channel_name(channel) + ", " + marks_name(marks)).c_str());
      }
  View view;
  view.compare = Compare::other;
  for (const CompareBy by : {CompareBy::wipe, CompareBy::difference}) {
    view.by = by;
    ViewFrame frame = frame_of({2, 1, 40, 30}, view);
    frame.picture = image.size();
    expect_same(frame, image, &other, {44, 33}, compare_by_name(by).c_str());
  }
  display_ = nullptr;
}

/// Of the table's codes, targets that encode make the same codes again.
TEST_F(ViewPassTest, TargetsThatEncodeShowTheDisplaysCodes) {
  const DisplayTable table = odd_table();
  Image image(1, 1, 4);
  for (float& v : image.pixels) v = 0.214f;
  const GpuImage gpu = upload(image);
  ViewFrame frame = frame_of({0, 0, 2, 2}, {});
  frame.picture = {1, 1};
  frame.shown = {gpu.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, image.size()};
  display_ = &table;
  const Image drawn = draw(frame, {2, 2}, {gpu.get()}, VK_FORMAT_R8G8B8A8_SRGB);
  display_ = nullptr;
  std::array<std::uint8_t, 4> texel{};
  std::memcpy(texel.data(), drawn.pixels.data(), texel.size());
  const auto wanted = read_display_table(table, {0.214, 0.214, 0.214});
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(texel[c], 255 * wanted[c], 1);
}

TEST_F(ViewPassTest, TargetsThatEncodeAreNotEncodedTwice) {
  Image image(1, 1, 4);
  for (float& v : image.pixels) v = 0.214f;
  const GpuImage gpu = upload(image);
  ViewFrame frame = frame_of({0, 0, 2, 2}, {});
  frame.picture = {1, 1};
  frame.shown = {gpu.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, image.size()};
  const Image drawn = draw(frame, {2, 2}, {gpu.get()}, VK_FORMAT_R8G8B8A8_SRGB);
  std::uint32_t texel = 0;
  std::memcpy(&texel, drawn.pixels.data(), sizeof texel);
  EXPECT_NEAR(static_cast<int>(texel & 0xff), 127, 1);  // sRGB code of 0.214
}

}  // namespace
}  // namespace afterglow
