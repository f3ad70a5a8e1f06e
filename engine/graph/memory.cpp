// SPDX-License-Identifier: MIT
#include "graph/memory.h"

#include <algorithm>

#include "graph/history.h"
#include "graph/plan.h"

namespace afterglow {

std::uint64_t memory_needed(const Graph& graph, const ExecutionConfig& config) {
  const std::uint64_t bytes_per_pixel = config.storage == Storage::fp16 ? 8 : 16;
  const Plan plan = make_plan(graph, config);
  std::vector<Block> blocks;
  std::uint64_t kept = 0;
  for (std::size_t i = 0; i < plan.transient.size(); ++i) {
    const auto pixels = static_cast<std::uint64_t>(graph.images[plan.transient[i]].size.area());
    const auto channels = static_cast<std::uint64_t>(stored_channels(graph, plan.transient[i], config));
    const std::uint64_t bytes = pixels * channels * (is_precise(graph, plan.transient[i]) ? 4 : bytes_per_pixel / 4);
    // Both images of a history have memory of their own.
    if (history_of_next(graph, plan.transient[i])) {
      kept += 2 * bytes;
      continue;
    }
    blocks.push_back({bytes, 1, plan.lifetimes[i].first, plan.lifetimes[i].last});
  }
  std::uint64_t total = kept + place(blocks, config.share_memory).total;
  // CPU devices may draw a sample pass twice, and mark in 16 bits a pixel what the first draw has done.
  std::uint64_t marks = 0;
  for (const auto& pass : graph.passes)
    if (pass.kind == PassKind::sample)
      marks = std::max(marks, static_cast<std::uint64_t>(graph.images[pass.output].size.area()) * 2);
  total += marks;
  for (std::size_t i = 0; i < graph.images.size(); ++i)
    if (const GraphImage& image = graph.images[i];
        image.producer < 0 && !history_of_previous(graph, static_cast<ImageId>(i)))
      total += static_cast<std::uint64_t>(image.size.area()) * bytes_per_pixel;
  return total;
}

}  // namespace afterglow
