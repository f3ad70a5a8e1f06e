// SPDX-License-Identifier: MIT
// Scopes as pixels: light lies where the values are, and nowhere else.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "window/atlas_cells.h"
#include "window/scope_picture.h"

namespace afterglow {
namespace {

constexpr int kSide = AtlasCells::kSide;

struct Lit {
  int x = 0, y = 0;
  int red = 0, green = 0, blue = 0;
};

/// All that is not as dark as an empty scope, from the upper left on.
std::vector<Lit> lit(const Scopes& scopes, ScopeKind kind) {
  const auto pixels = scope_picture(scopes, kind);
  const auto empty = scope_picture(Scopes{}, ScopeKind::none);
  EXPECT_EQ(pixels.size(), static_cast<std::size_t>(kSide * kSide));
  std::vector<Lit> out;
  for (int i = 0; i < kSide * kSide; ++i) {
    const ImU32 c = pixels[static_cast<std::size_t>(i)];
    EXPECT_EQ(c >> IM_COL32_A_SHIFT, 255u);
    if (c == empty[static_cast<std::size_t>(i)]) continue;
    const auto part = [c](int shift) { return static_cast<int>((c >> shift) & 255u); };
    out.push_back({i % kSide, i / kSide, part(IM_COL32_R_SHIFT), part(IM_COL32_G_SHIFT), part(IM_COL32_B_SHIFT)});
  }
  return out;
}

/// The left half black, the right half linear 0.25 (code 137) of red alone.
Scopes half_red() {
  std::vector<float> pixels;
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 512; ++x) pixels.insert(pixels.end(), {x < 256 ? 0.0f : 0.25f, 0, 0, 1});
  return scopes_of(pixels, {512, 8});
}

TEST(ScopePicture, ParadeHasEachChannelInItsThird) {
  for (const Lit& at : lit(half_red(), ScopeKind::parade)) {
    if (at.y == kSide - 1) continue;  // black
    EXPECT_EQ(at.y, kSide - 1 - 137);
    EXPECT_GE(at.x, 42);
    EXPECT_LT(at.x, 84);
    EXPECT_GT(at.red, at.green + 30);
  }
  EXPECT_EQ(lit(half_red(), ScopeKind::parade).size(), static_cast<std::size_t>(42 + 42 + 84 + 84));
}

TEST(ScopePicture, WaveformHasLuminanceOverTheWidth) {
  const auto found = lit(half_red(), ScopeKind::waveform);
  ASSERT_EQ(found.size(), static_cast<std::size_t>(kSide));
  const int level = scope_level(ScopeScale::code, 0.2126f * 0.25f);
  for (const Lit& at : found) EXPECT_EQ(at.y, kSide - 1 - (at.x < kSide / 2 ? 0 : level)) << at.x;
}

TEST(ScopePicture, VectorscopeHasColorsWhereTheyBelong) {
  const auto found = lit(half_red(), ScopeKind::vectorscope);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[1].x, kSide / 2);
  EXPECT_EQ(found[1].y, kSide / 2 - 1) << "what has no colour";
  EXPECT_LT(found[0].y, found[1].y) << "red: Cr is above";
  EXPECT_LT(found[0].x, found[1].x) << "and Cb at the left";
  EXPECT_GT(found[0].red, found[0].green + 50);
}

TEST(ScopePicture, HistogramStandsOnItsFloor) {
  int tallest = 0;
  for (const Lit& at : lit(half_red(), ScopeKind::histogram)) {
    EXPECT_TRUE(at.x == 0 || at.x == 137) << at.x;
    if (at.x == 137) tallest = std::max(tallest, kSide - at.y);
  }
  EXPECT_EQ(tallest, kSide) << "the largest count between the ends sets the height";
}

TEST(ScopePicture, NothingIsDark) {
  const Scopes nothing = scopes_of({}, {});
  for (const ScopeKind kind : {ScopeKind::histogram, ScopeKind::waveform, ScopeKind::parade, ScopeKind::vectorscope})
    EXPECT_TRUE(lit(nothing, kind).empty());
}

}  // namespace
}  // namespace afterglow
