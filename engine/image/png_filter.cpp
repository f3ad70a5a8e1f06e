// SPDX-License-Identifier: MIT
#include "image/png_filter.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace afterglow {
namespace {

std::uint8_t paeth(int left, int above, int corner) {
  const int a = std::abs(above - corner), b = std::abs(left - corner), c = std::abs(left + above - 2 * corner);
  // Ties go to the left, then to the one above. Written with selects, so that it vectorises.
  const int vertical = b <= c ? above : corner;
  return static_cast<std::uint8_t>(a <= b && a <= c ? left : vertical);
}

/// Bytes taken as signed: the smaller, the likelier to compress well.
std::uint32_t weight(const std::uint8_t* bytes, std::size_t size) {
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i < size; ++i)
    sum += static_cast<std::uint32_t>(std::abs(static_cast<std::int8_t>(bytes[i])));
  return sum;
}

}  // namespace

void png_filter_row(const std::uint8_t* row, const std::uint8_t* above, std::size_t size, std::size_t pixel,
                    std::uint8_t* scratch, std::uint8_t* out) {
  std::uint8_t *sub = scratch, *up = scratch + size, *average = scratch + 2 * size, *best_of_both = scratch + 3 * size;
  const std::size_t head = std::min(pixel, size);
  std::copy_n(row, head, sub);
  for (std::size_t i = head; i < size; ++i) sub[i] = static_cast<std::uint8_t>(row[i] - row[i - pixel]);
  const std::uint8_t* best = sub;
  std::uint8_t filter = 1;
  if (above) {
    for (std::size_t i = 0; i < size; ++i) up[i] = static_cast<std::uint8_t>(row[i] - above[i]);
    for (std::size_t i = 0; i < head; ++i) {
      average[i] = static_cast<std::uint8_t>(row[i] - above[i] / 2);
      best_of_both[i] = up[i];  // Paeth of nothing, above, nothing
    }
    for (std::size_t i = head; i < size; ++i) {
      average[i] = static_cast<std::uint8_t>(row[i] - (row[i - pixel] + above[i]) / 2);
      best_of_both[i] = static_cast<std::uint8_t>(row[i] - paeth(row[i - pixel], above[i], above[i - pixel]));
    }
    std::uint32_t smallest = weight(sub, size);
    const std::uint8_t* candidates[] = {up, average, best_of_both};
    for (std::uint8_t f = 0; f < 3; ++f) {
      const std::uint32_t w = weight(candidates[f], size);
      if (w >= smallest) continue;
      smallest = w;
      best = candidates[f];
      filter = static_cast<std::uint8_t>(f + 2);
    }
  }
  out[0] = filter;
  std::memcpy(out + 1, best, size);
}

}  // namespace afterglow
