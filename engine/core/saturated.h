// SPDX-License-Identifier: MIT
// Sums and products of sizes that files claim: what does not fit is the largest number, so that no limit is slipped
// under by running over.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <limits>

namespace afterglow {

inline constexpr std::uint64_t kSaturated = std::numeric_limits<std::uint64_t>::max();

constexpr std::uint64_t saturated_sum(std::initializer_list<std::uint64_t> numbers) {
  std::uint64_t sum = 0;
  for (const std::uint64_t number : numbers) sum = number > kSaturated - sum ? kSaturated : sum + number;
  return sum;
}

constexpr std::uint64_t saturated_product(std::initializer_list<std::uint64_t> numbers) {
  std::uint64_t product = 1;
  for (const std::uint64_t number : numbers)
    if (number == 0) return 0;
  for (const std::uint64_t number : numbers) product = product > kSaturated / number ? kSaturated : product * number;
  return product;
}

}  // namespace afterglow
