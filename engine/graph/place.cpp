// SPDX-License-Identifier: MIT
#include <algorithm>
#include <numeric>

#include "graph/plan.h"

namespace afterglow {
namespace {

std::uint64_t align_up(std::uint64_t value, std::uint64_t alignment) {
  alignment = std::max<std::uint64_t>(alignment, 1);
  return (value + alignment - 1) / alignment * alignment;
}

bool overlap(const Block& a, const Block& b) { return a.first <= b.last && b.first <= a.last; }

std::uint64_t most_alive_at_once(const std::vector<Block>& blocks) {
  std::uint64_t most = 0;
  for (const Block& moment : blocks) {  // the maximum is reached at the start of some block
    std::uint64_t alive = 0;
    for (const Block& block : blocks)
      if (block.first <= moment.first && moment.first <= block.last) alive += block.size;
    most = std::max(most, alive);
  }
  return most;
}

// Lowest offset at which `block` collides with no placed block that lives at the same time.
std::uint64_t first_fit(const Block& block, std::vector<std::pair<std::uint64_t, std::uint64_t>> taken) {
  std::sort(taken.begin(), taken.end());
  std::uint64_t offset = 0;
  for (const auto& [begin, end] : taken) {
    if (offset + block.size <= begin) break;
    offset = std::max(offset, align_up(end, block.alignment));
  }
  return offset;
}

}  // namespace

Placement place(const std::vector<Block>& blocks, bool share) {
  Placement out;
  out.offsets.resize(blocks.size());
  out.lower_bound = most_alive_at_once(blocks);
  std::vector<std::size_t> order(blocks.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return blocks[a].size > blocks[b].size; });
  std::vector<std::size_t> placed;
  for (const std::size_t i : order) {
    std::vector<std::pair<std::uint64_t, std::uint64_t>> taken;
    for (const std::size_t j : placed)
      if (!share || overlap(blocks[i], blocks[j])) taken.emplace_back(out.offsets[j], out.offsets[j] + blocks[j].size);
    out.offsets[i] = first_fit(blocks[i], std::move(taken));
    out.total = std::max(out.total, out.offsets[i] + blocks[i].size);
    out.sum += blocks[i].size;
    placed.push_back(i);
  }
  return out;
}

}  // namespace afterglow
