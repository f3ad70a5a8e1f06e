// SPDX-License-Identifier: MIT
// Filters of PNG against their definition (ISO/IEC 15948, 9).
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <random>
#include <vector>

#include "image/png_filter.h"

namespace afterglow {
namespace {

using Row = std::vector<std::uint8_t>;

int predicted(int filter, int left, int above, int corner) {
  if (filter == 1) return left;
  if (filter == 2) return above;
  if (filter == 3) return (left + above) / 2;
  const int p = left + above - corner, a = std::abs(p - left), b = std::abs(p - above), c = std::abs(p - corner);
  return a <= b && a <= c ? left : b <= c ? above : corner;
}

Row filtered(int filter, const Row& row, const Row& above, std::size_t pixel) {
  Row out(row.size());
  for (std::size_t i = 0; i < row.size(); ++i) {
    const bool first = i < pixel;
    out[i] = static_cast<std::uint8_t>(
        row[i] - predicted(filter, first ? 0 : row[i - pixel], above[i], first ? 0 : above[i - pixel]));
  }
  return out;
}

int weight(const Row& row) {
  int sum = 0;
  for (const std::uint8_t byte : row) sum += std::abs(static_cast<std::int8_t>(byte));
  return sum;
}

TEST(PngFilter, IsTheOneOfLeastWeight) {
  std::mt19937 random(5);
  std::array<int, 5> chosen{};
  for (int trial = 0; trial < 3000; ++trial) {
    const std::size_t pixel = std::array{3u, 4u, 6u, 8u}[static_cast<std::size_t>(trial) % 4];
    const std::size_t size = pixel * (1 + random() % 90);
    const unsigned noise = 1 + random() % 255, slope = random() % 4, shift = random() % 256;
    Row row(size), above(size), scratch(4 * size), out(size + 1);
    for (std::size_t i = 0; i < size; ++i) {
      above[i] = static_cast<std::uint8_t>(i * slope + random() % noise);
      row[i] = trial % 3 == 0 ? static_cast<std::uint8_t>(above[i] + shift + random() % 3)
                              : static_cast<std::uint8_t>(i * slope + random() % noise);
    }
    png_filter_row(row.data(), above.data(), size, pixel, scratch.data(), out.data());
    int best = 1;
    for (int filter = 2; filter <= 4; ++filter)
      if (weight(filtered(filter, row, above, pixel)) < weight(filtered(best, row, above, pixel))) best = filter;
    ASSERT_EQ(out[0], best) << trial;
    ASSERT_EQ(Row(out.begin() + 1, out.end()), filtered(best, row, above, pixel)) << trial;
    ++chosen[out[0]];
  }
  for (std::size_t filter = 1; filter <= 4; ++filter) EXPECT_GT(chosen[filter], 20) << filter;
}

TEST(PngFilter, TheFirstRowHasNothingAbove) {
  const Row row{10, 20, 30, 15, 40, 30};
  Row scratch(4 * row.size()), out(row.size() + 1);
  png_filter_row(row.data(), nullptr, row.size(), 3, scratch.data(), out.data());
  EXPECT_EQ(out, (Row{1, 10, 20, 30, 5, 20, 0}));
}

}  // namespace
}  // namespace afterglow
