// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "image/orientation.h"

namespace afterglow {
namespace {

/// Exif's own definition, by where the stored corner (0,0), first row and first column are seen.
///  1: row 0 top, column 0 left      2: top, right    3: bottom, right   4: bottom, left
///  5: row 0 left, column 0 top      6: right, top    7: right, bottom   8: left, bottom
struct Seen {
  bool row0_on_side, row0_far, column0_far;
};
constexpr Seen kSeen[] = {{},
                          {false, false, false},
                          {false, false, true},
                          {false, true, true},
                          {false, true, false},
                          {true, false, false},
                          {true, true, false},
                          {true, true, true},
                          {true, false, true}};

TEST(Orientation, AllEightByTheDefinition) {
  Image stored(3, 2, 1);
  for (int i = 0; i < 6; ++i) stored.pixels[static_cast<std::size_t>(i)] = static_cast<float>(i + 1);
  for (int o = 1; o <= 8; ++o) {
    const Image turned = upright(stored, o);
    const Seen& seen = kSeen[o];
    ASSERT_EQ(turned.width, seen.row0_on_side ? 2 : 3) << o;
    ASSERT_EQ(turned.height, seen.row0_on_side ? 3 : 2) << o;
    for (int y = 0; y < 2; ++y) {
      for (int x = 0; x < 3; ++x) {
        // The stored row number counts away from where row 0 is seen, the column number away from where column 0 is.
        const int along_rows = seen.row0_far ? 1 - y : y, along_columns = seen.column0_far ? 2 - x : x;
        const int seen_x = seen.row0_on_side ? along_rows : along_columns,
                  seen_y = seen.row0_on_side ? along_columns : along_rows;
        EXPECT_EQ(*turned.at(seen_x, seen_y), *stored.at(x, y)) << "orientation " << o;
      }
    }
  }
}

/// From one pixel to the next one, before and after.
TEST(Orientation, VectorsTurnWithThePixels) {
  for (int o = 1; o <= 8; ++o) {
    Image marks(5, 4, 1), vectors(5, 4, 2);
    *marks.at(1, 1) = 1;
    *marks.at(3, 2) = 2;
    for (std::size_t i = 0; i < vectors.pixels.size(); i += 2) vectors.pixels[i] = 2, vectors.pixels[i + 1] = 1;
    const Image turned = upright(marks, o);
    vectors = upright(std::move(vectors), o);
    turn_vectors(vectors, o);
    const auto place = [&](float mark) {
      const auto at = static_cast<int>(std::ranges::find(turned.pixels, mark) - turned.pixels.begin());
      return std::pair(at % turned.width, at / turned.width);
    };
    const auto [x0, y0] = place(1);
    const auto [x1, y1] = place(2);
    EXPECT_EQ(vectors.at(x0, y0)[0], static_cast<float>(x1 - x0)) << o;
    EXPECT_EQ(vectors.at(x0, y0)[1], static_cast<float>(y1 - y0)) << o;
  }
}

TEST(Orientation, WindowsTurnWithThePixels) {
  // Mark the data window's pixels inside the display window, turn the whole, and look where they are.
  const Rect display{10, 20, 5, 4}, data{11, 20, 2, 3};
  for (int o = 1; o <= 8; ++o) {
    Image marks(display.width, display.height, 1);
    for (int y = 0; y < data.height; ++y)
      for (int x = 0; x < data.width; ++x) *marks.at(data.x - display.x + x, data.y - display.y + y) = 1;
    const Image turned = upright(marks, o);
    const Rect new_display = upright(display, display, o), new_data = upright(data, display, o);
    ASSERT_EQ(new_display.size(), turned.size()) << o;
    EXPECT_EQ(new_data.size().area(), data.size().area()) << o;
    for (int y = 0; y < turned.height; ++y) {
      for (int x = 0; x < turned.width; ++x) {
        const int fx = new_display.x + x, fy = new_display.y + y;
        const bool inside = fx >= new_data.x && fx < new_data.x + new_data.width && fy >= new_data.y &&
                            fy < new_data.y + new_data.height;
        EXPECT_EQ(*turned.at(x, y) == 1, inside) << "orientation " << o << " at " << x << "," << y;
      }
    }
  }
}

TEST(Orientation, NumbersOutsideAreUpright) {
  Image image(2, 1, 3);
  image.pixels = {1, 2, 3, 4, 5, 6};
  for (const int o : {-1, 0, 1, 9, 1000}) EXPECT_EQ(upright(image, o).pixels, image.pixels);
  EXPECT_EQ(upright(image, 2).pixels, (std::vector<float>{4, 5, 6, 1, 2, 3}));
}

}  // namespace
}  // namespace afterglow
