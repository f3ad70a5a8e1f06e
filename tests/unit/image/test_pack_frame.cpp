// SPDX-License-Identifier: MIT
// Frames of videos against the same sums in double precision.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>

#include "image/encode.h"
#include "image/input_space.h"
#include "image/pack_frame.h"
#include "image/palette.h"

namespace afterglow {
namespace {

/// Stored values of the sRGB codes of this pixel, and its alpha.
std::array<double, 4> stored_of(int x, int y, bool alpha) {
  const double a = alpha ? 0.25 + 0.75 * ((x * 5 + y * 3) % 11) / 10.0 : 1;
  return {0.5 + 0.45 * std::sin(x * 0.7 + y), 0.5 + 0.45 * std::cos(x * 0.3 - y * 0.9), 0.2 + 0.7 * ((x + y) % 7) / 6.0,
          a};
}

Picture picture_of(int width, int height, bool alpha) {
  const InputSpace& srgb = *find_input_space("srgb").value();
  Picture picture;
  picture.color = Image(width, height, 4);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto v = stored_of(x, y, alpha);
      for (std::size_t c = 0; c < 3; ++c) picture.color.at(x, y)[c] = static_cast<float>(srgb.to_linear(v[c]) * v[3]);
      picture.color.at(x, y)[3] = static_cast<float>(v[3]);
    }
  picture.has_alpha = alpha;
  picture.data_window = picture.display_window = {0, 0, width, height};
  return picture;
}

int code_at(const PackedFrame& frame, std::size_t plane, int x, int y) {
  const auto& p = frame.planes[plane];
  const std::uint8_t* row = frame.bytes.data() + p.offset + p.stride * static_cast<std::size_t>(y);
  if (frame.layout->bits == 8) return row[x];
  std::uint16_t code = 0;
  std::memcpy(&code, row + 2 * x, 2);
  return code;
}

class Yuv : public testing::TestWithParam<const char*> {};

void expect_nearest_codes(const PixelLayout& layout, int width, int height) {
  const PackRules rules{&layout, find_output_space("srgb").value(), kBt709Luma, false};
  // Memory of another frame may hold anything.
  const PackedFrame frame =
      pack_frame(picture_of(width, height, layout.alpha), rules, std::vector<std::uint8_t>(1000, 77));
  const double scale = 1 << (layout.bits - 8);
  const auto yuv = [&](int x, int y) -> std::array<double, 3> {
    const auto v = stored_of(std::clamp(x, 0, width - 1), std::clamp(y, 0, height - 1), layout.alpha);
    const double l = 0.2126 * v[0] + 0.7152 * v[1] + 0.0722 * v[2];
    return {l, (v[2] - l) / 1.8556, (v[0] - l) / 1.5748};
  };
  // Half a code of rounding, and the float's table of the curve.
  const double off = 0.5 + 8e-6 * (1 << layout.bits) + 1e-3;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      ASSERT_NEAR(code_at(frame, 0, x, y), (16 + 219 * yuv(x, y)[0]) * scale, off) << x << "," << y;
      if (layout.alpha) {
        ASSERT_NEAR(code_at(frame, 3, x, y), stored_of(x, y, true)[3] * ((1 << layout.bits) - 1), off);
      }
    }
  for (int y = 0; y < frame.planes[1].rows; ++y)
    for (int x = 0; x < width >> layout.chroma_x; ++x)
      for (std::size_t c = 1; c < 3; ++c) {
        double sum = 0;
        for (int j = -1; j <= 2; ++j)
          for (int i = -1; i <= 1; ++i) {
            const double across = layout.chroma_x == 0 ? (i == 0 ? 1 : 0) : i == 0 ? 0.5 : 0.25;
            const double down = layout.chroma_y == 0 ? (j == 0 ? 1 : 0) : j == 0 || j == 1 ? 0.375 : 0.125;
            sum += across * down * yuv((x << layout.chroma_x) + i, (y << layout.chroma_y) + j)[c];
          }
        ASSERT_NEAR(code_at(frame, c, x, y), (128 + 224 * sum) * scale, off) << x << "," << y << " " << c;
      }
}

TEST_P(Yuv, IsTheNearestCode) { expect_nearest_codes(*find_pixel_layout(GetParam()), 22, 14); }
/// Made in several bands, whose rows of chroma look over their edges.
TEST_P(Yuv, LargeOnesAreTheNearestCodesToo) { expect_nearest_codes(*find_pixel_layout(GetParam()), 402, 301); }

/// What the file holds may be smaller than what is shown, or larger.
TEST_P(Yuv, AnotherDataWindowIsFilledOrCut) {
  const PackRules rules{find_pixel_layout(GetParam()), find_output_space("srgb").value(), kBt709Luma, false};
  const bool alpha = rules.layout->alpha;
  Picture part = picture_of(9, 7, alpha);
  part.data_window = {3, -2, 9, 7};
  part.display_window = {0, 0, 10, 8};
  Picture whole = part;
  whole.data_window = whole.display_window;
  whole.color = Image(10, 8, 4);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 10; ++x) {
      const bool held = x >= 3 && y < 5;
      for (std::size_t c = 0; c < 4; ++c)
        whole.color.at(x, y)[c] = held ? part.color.at(x - 3, y + 2)[c] : c == 3 && !alpha ? 1.0f : 0.0f;
    }
  EXPECT_EQ(pack_frame(part, rules, {}).bytes, pack_frame(whole, rules, {}).bytes);
}

INSTANTIATE_TEST_SUITE_P(All, Yuv,
                         testing::Values("yuv420p", "yuv422p", "yuv444p", "yuv420p10", "yuv422p12", "yuv444p16",
                                         "yuva420p", "yuva444p10"));

TEST(PackFrame, RgbInEveryOrder) {
  for (const PixelLayout& layout : pixel_layouts()) {
    if (!layout.rgb_colors()) continue;
    const PackRules rules{&layout, find_output_space("srgb").value(), kBt709Luma, false};
    const PackedFrame frame = pack_frame(picture_of(9, 5, layout.alpha), rules);
    const double most = (1 << layout.bits) - 1;
    for (int y = 0; y < 5; ++y)
      for (int x = 0; x < 9; ++x)
        for (int c = 0; c < (layout.alpha ? 4 : 3); ++c) {
          constexpr std::array<std::size_t, 4> kPlane{2, 0, 1, 3};
          const int place = layout.kind == PixelLayout::Kind::bgr && c < 3 ? 2 - c : c;
          const auto channel = static_cast<std::size_t>(c);
          const int code = layout.packed() ? code_at(frame, 0, x * layout.channels + place, y)
                                           : code_at(frame, kPlane[channel], x, y);
          ASSERT_NEAR(code, stored_of(x, y, layout.alpha)[channel] * most, 0.51 + 8e-6 * most)
              << layout.name << " " << x << "," << y << " " << c;
        }
  }
}

TEST(PackFrame, NoiseKeepsTheMean) {
  Picture picture = picture_of(64, 64, false);
  const InputSpace& srgb = *find_input_space("srgb").value();
  const double stored = 100.3 / 255;
  for (std::size_t i = 0; i < picture.color.pixels.size(); ++i)
    if (i % 4 < 3) picture.color.pixels[i] = static_cast<float>(srgb.to_linear(stored));
  const PackRules rules{find_pixel_layout("yuv444p"), find_output_space("srgb").value(), kBt709Luma, true};
  const PackedFrame frame = pack_frame(picture, rules);
  double sum = 0;
  for (int i = 0; i < 64 * 64; ++i) sum += frame.bytes[static_cast<std::size_t>(i)];
  EXPECT_NEAR(sum / (64 * 64), 16 + 219 * stored, 0.01);
}

/// Codes that are exact up to a float's last bits get no noise, as in pictures.
TEST(PackFrame, ExactCodesStay) {
  Picture picture = picture_of(256, kBlueNoiseSize, false);
  const InputSpace& srgb = *find_input_space("srgb").value();
  for (int y = 0; y < kBlueNoiseSize; ++y)
    for (int x = 0; x < 256; ++x)
      for (std::size_t c = 0; c < 3; ++c)
        picture.color.at(x, y)[c] = static_cast<float>(srgb.to_linear(((x + y) % 256) / 255.0));
  const PackRules rules{find_pixel_layout("rgb24"), find_output_space("srgb").value(), kBt709Luma, true};
  const PackedFrame frame = pack_frame(picture, rules);
  for (int y = 0; y < kBlueNoiseSize; ++y)
    for (int x = 0; x < 256 * 3; ++x) ASSERT_EQ(code_at(frame, 0, x, y), (x / 3 + y) % 256) << x << "," << y;
}

TEST(PixelLayout, NamesAndSizes) {
  EXPECT_EQ(find_pixel_layout("yuv420p10"), find_pixel_layout("yuv420p10le"));
  EXPECT_EQ(find_pixel_layout("yuv420p9"), nullptr);
  const PackedFrame odd = empty_frame(*find_pixel_layout("yuv420p"), {5, 3});
  EXPECT_EQ(odd.bytes.size(), 15u + 6 + 6);
  EXPECT_EQ(empty_frame(*find_pixel_layout("rgba64le"), {5, 3}).bytes.size(), 120u);
}

TEST(Palette, FewColoursStay) {
  PackedFrame frame = empty_frame(*find_pixel_layout("rgba"), {16, 16});
  for (std::size_t i = 0; i < 256; ++i) {
    const std::array<std::uint8_t, 4> pixel{static_cast<std::uint8_t>(i % 16 * 16),
                                            static_cast<std::uint8_t>(i / 128 * 200), 7,
                                            static_cast<std::uint8_t>(i % 4 == 0 ? 0 : 255)};
    std::copy(pixel.begin(), pixel.end(), frame.bytes.begin() + static_cast<std::ptrdiff_t>(i * 4));
  }
  const PalettePicture picture = palette_picture(frame);
  for (std::size_t i = 0; i < 256; ++i) {
    const std::uint32_t color = picture.colors[picture.indices[i]];
    if (i % 4 == 0) {
      EXPECT_EQ(color >> 24, 0u);
      continue;
    }
    EXPECT_EQ(color >> 24, 255u);
    EXPECT_EQ(color >> 16 & 255, i % 16 * 16);
    EXPECT_EQ(color >> 8 & 255, i / 128 * 200);
    EXPECT_EQ(color & 255, 7u);
  }
}

}  // namespace
}  // namespace afterglow
