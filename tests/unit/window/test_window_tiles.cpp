// SPDX-License-Identifier: MIT
// Which parts of a window have changed, and which triangles of the interface they need.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "window/interface.h"
#include "window/ui_pieces.h"
#include "window/window_tiles.h"

namespace afterglow {
namespace {

bool holds(const std::vector<Rect>& rects, int x, int y) {
  return std::ranges::any_of(
      rects, [&](const Rect& r) { return x >= r.x && y >= r.y && x < r.x + r.width && y < r.y + r.height; });
}

TEST(WindowTiles, NothingThatChangesIsNothing) {
  WindowTiles tiles;
  tiles.begin({100, 50}, 1);
  tiles.add({10, 10, 20, 20}, 5);
  const auto before = tiles.numbers();
  tiles.begin({100, 50}, 1);
  tiles.add({10, 10, 20, 20}, 5);
  EXPECT_TRUE(tiles.changed(before).empty());
}

TEST(WindowTiles, AnotherSizeOrAnotherWholeIsAll) {
  WindowTiles tiles;
  tiles.begin({100, 50}, 1);
  EXPECT_EQ(tiles.changed({}), (std::vector<Rect>{{0, 0, 100, 50}}));
  const auto before = tiles.numbers();
  tiles.begin({100, 50}, 2);
  EXPECT_EQ(tiles.changed(before), (std::vector<Rect>{{0, 0, 100, 50}}));
}

TEST(WindowTiles, TheOrderCounts) {
  WindowTiles tiles;
  tiles.begin({64, 64}, 0);
  tiles.add({0, 0, 64, 64}, 1);
  tiles.add({20, 20, 1, 1}, 2);
  const auto before = tiles.numbers();
  tiles.begin({64, 64}, 0);
  tiles.add({20, 20, 1, 1}, 2);
  tiles.add({0, 0, 64, 64}, 1);
  EXPECT_EQ(tiles.changed(before), (std::vector<Rect>{{16, 16, 16, 16}}));
}

TEST(WindowTiles, WhatLiesBesideTheWindowDoesNotCount) {
  WindowTiles tiles;
  tiles.begin({40, 40}, 0);
  const auto before = tiles.numbers();
  tiles.add({-30, 5, 20, 20}, 1);
  tiles.add({40, 5, 20, 20}, 1);
  tiles.add({5, 5, 0, 20}, 1);
  EXPECT_TRUE(tiles.changed(before).empty());
  tiles.add({-30, 5, 31, 1}, 1);
  EXPECT_EQ(tiles.changed(before), (std::vector<Rect>{{0, 0, 16, 16}}));
}

TEST(WindowTiles, ChangedPartsHoldAllThatChangedAndShareNoPixel) {
  std::mt19937 random(7);
  const Size window{333, 217};
  for (int round = 0; round < 200; ++round) {
    WindowTiles tiles;
    tiles.begin(window, 0);
    const auto before = tiles.numbers();
    std::vector<Rect> drawn;
    for (unsigned i = 0; i < random() % 9; ++i) {
      drawn.push_back({static_cast<int>(random() % 340) - 5, static_cast<int>(random() % 220) - 5,
                       1 + static_cast<int>(random() % 60), 1 + static_cast<int>(random() % 60)});
      tiles.add(drawn.back(), i + 1);
    }
    const std::vector<Rect> changed = tiles.changed(before);
    for (int y = 0; y < window.height; ++y)
      for (int x = 0; x < window.width; ++x) {
        if (holds(drawn, x, y)) {
          ASSERT_TRUE(holds(changed, x, y)) << x << ", " << y;
        }
      }
    for (std::size_t i = 0; i < changed.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) EXPECT_EQ(common_part(changed[i], changed[j]).size().area(), 0);
    for (const Rect& part : changed) EXPECT_EQ(common_part(part, {0, 0, window.width, window.height}), part);
  }
}

class UiPiecesTest : public testing::Test {
 protected:
  UiPiecesTest() : interface_(nullptr) {
    const ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    pieces_.take_atlas({atlas.TexWidth, atlas.TexHeight});
  }
  template <class Draw>
  std::vector<std::uint64_t> numbers(const Draw& draw, std::span<const Rect> written = {}) {
    interface_.begin({320, 200});
    draw(*ImGui::GetForegroundDrawList());
    const ImDrawData& data = interface_.end();
    pieces_.take(data, {320, 200}, written);
    tiles_.begin({320, 200}, 0);
    pieces_.add_to(tiles_);
    return tiles_.numbers();
  }
  Interface interface_;
  UiPieces pieces_;
  WindowTiles tiles_;
};

TEST_F(UiPiecesTest, ColourPlaceAndClipOfATriangleCount) {
  const auto rect = [&](ImVec2 at, ImU32 color, ImVec4 clip) {
    return numbers([&](ImDrawList& list) {
      list.PushClipRect({clip.x, clip.y}, {clip.z, clip.w});
      list.AddRectFilled(at, {at.x + 10, at.y + 10}, color);
      list.PopClipRect();
    });
  };
  const ImVec4 all{0, 0, 320, 200};
  const auto first = rect({40, 40}, IM_COL32_WHITE, all);
  EXPECT_EQ(rect({40, 40}, IM_COL32_WHITE, all), first);
  EXPECT_NE(rect({40, 40}, IM_COL32(255, 255, 254, 255), all), first);
  EXPECT_NE(rect({40.25f, 40}, IM_COL32_WHITE, all), first);
  EXPECT_NE(rect({40, 40}, IM_COL32_WHITE, {0, 0, 45, 200}), first);
  // Only the tiles that it reaches.
  rect({40, 40}, IM_COL32_BLACK, all);
  EXPECT_EQ(tiles_.changed(first), (std::vector<Rect>{{32, 32, 32, 32}}));
}

TEST_F(UiPiecesTest, WhatIsReadOfTheAtlasCounts) {
  const ImFontGlyph& a = *interface_.ui().body->FindGlyph('a');
  const ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  const auto text = [&](std::span<const Rect> written) {
    return numbers([](ImDrawList& list) { list.AddText({40, 40}, IM_COL32_WHITE, "a"); }, written);
  };
  const Rect glyph{static_cast<int>(a.U0 * static_cast<float>(atlas.TexWidth)),
                   static_cast<int>(a.V0 * static_cast<float>(atlas.TexHeight)), 6, 6};
  const Rect elsewhere{glyph.x < 300 ? glyph.x + 200 : 0, 0, 1, 1};
  const auto first = text({});
  EXPECT_EQ(text({&elsewhere, 1}), first);
  const auto second = text({&glyph, 1});
  EXPECT_NE(second, first);
  EXPECT_EQ(text({}), second);
  EXPECT_NE(text({&glyph, 1}), second);
}

TEST_F(UiPiecesTest, OnlyTrianglesOfThePartsAreWritten) {
  numbers([](ImDrawList& list) {
    for (int i = 0; i < 10; ++i) {
      const auto x = static_cast<float>(30 * i);
      list.AddRectFilled({x, 10}, {x + 20, 30}, IM_COL32_WHITE);
    }
  });
  std::vector<UiDraw> draws;
  std::vector<ImDrawIdx> indices;
  const Rect parts[] = {{32, 0, 16, 16}, {64, 0, 48, 32}, {0, 100, 320, 100}};
  pieces_.write(parts, draws, indices);
  ASSERT_EQ(draws.size(), 2u);
  EXPECT_EQ(draws[0].scissor, parts[0]);
  EXPECT_EQ(draws[0].count, 6u);   // the second square
  EXPECT_EQ(draws[1].count, 12u);  // the third and the fourth
  EXPECT_EQ(draws[1].first_index, 6u);
  EXPECT_EQ(indices.size(), 18u);
}

/// A driver that takes a draw apart takes no rectangle apart.
TEST_F(UiPiecesTest, LongDrawsEndBetweenRectangles) {
  numbers([](ImDrawList& list) {
    list.AddTriangleFilled({1, 1}, {9, 1}, {5, 9}, IM_COL32_WHITE);
    for (int i = 0; i < 900; ++i) {
      const auto x = static_cast<float>(10 * (i % 30)), y = static_cast<float>(6 * (i / 30));
      list.AddRectFilled({x, y}, {x + 9, y + 5}, IM_COL32_WHITE);
    }
  });
  std::vector<UiDraw> draws;
  std::vector<ImDrawIdx> indices;
  const Rect all{0, 0, 320, 200};
  pieces_.write({&all, 1}, draws, indices);
  EXPECT_GT(draws.size(), 5u);
  std::uint32_t first = 0;
  for (const UiDraw& draw : draws) {
    EXPECT_LE(draw.count, 1020u);
    EXPECT_EQ(draw.first_index, first);
    first += draw.count;
    // Of rectangles, both triangles: the last one has three of the four corners of its own.
    if (const ImDrawIdx* last = &indices[first - 6]; draw.count >= 6) {
      EXPECT_EQ(last[0], last[3]);
      EXPECT_EQ(last[2], last[4]);
    }
  }
  EXPECT_EQ(first, indices.size());
}

}  // namespace
}  // namespace afterglow
