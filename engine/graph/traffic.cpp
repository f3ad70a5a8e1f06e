// SPDX-License-Identifier: MIT
#include <set>

#include "graph/history.h"
#include "graph/memory.h"

namespace afterglow {
namespace {

/// Images that a kernel has to read: not what its own passes hand on.
std::set<ImageId> read_by(const Graph& graph, const PlanKernel& kernel) {
  std::set<ImageId> out;
  for (const int index : kernel.passes)
    for (const auto& input : graph.passes[static_cast<std::size_t>(index)].inputs) out.insert(input.image);
  for (const int index : kernel.passes) out.erase(graph.passes[static_cast<std::size_t>(index)].output);
  return out;
}

}  // namespace

Traffic traffic_of(const Graph& graph, const Plan& plan, const ExecutionConfig& config, const Regions* parts) {
  const std::uint64_t channel = config.storage == Storage::fp16 ? 2 : 4;
  const auto bytes_per_pixel = [&](ImageId image) -> std::uint64_t {
    const GraphImage& made = graph.images[static_cast<std::size_t>(image)];
    const bool given = made.producer < 0 && image != graph.source && !history_of_previous(graph, image);
    if (given) return known_channels(made.name) == 1 ? 4 : 16;
    return (is_precise(graph, image) ? 4 : channel) * static_cast<std::uint64_t>(stored_channels(graph, image, config));
  };
  const auto area = [&](ImageId image) -> std::uint64_t {
    const auto at = static_cast<std::size_t>(image);
    if (parts && !graph.images[at].data) return static_cast<std::uint64_t>(parts->images[at].size().area());
    return static_cast<std::uint64_t>(graph.images[at].size.area());
  };
  const std::uint64_t small = area(graph.result) / 2;
  Traffic out;
  if (plan.kernels.empty()) return out;
  std::set<ImageId> inputs;
  const auto count = [&](ImageId image, std::uint64_t pixels) {
    const std::uint64_t bytes = pixels * bytes_per_pixel(image);
    out.total += bytes;
    if (area(image) < small) out.small += bytes;
    return bytes;
  };
  for (std::size_t k = 0; k < plan.kernels.size(); ++k) {
    const PlanKernel& kernel = plan.kernels[k];
    KernelTraffic one{.name = kernel.name};
    if (plan.once[k]) {  // no frame but the first
      out.kernels.push_back(std::move(one));
      continue;
    }
    for (const ImageId image : read_by(graph, kernel)) {
      one.read += count(image, area(image));
      if (graph.images[static_cast<std::size_t>(image)].producer < 0) inputs.insert(image);
    }
    one.written =
        count(kernel.output, parts ? static_cast<std::uint64_t>(parts->kernels[k].size().area()) : area(kernel.output));
    out.kernels.push_back(std::move(one));
  }
  for (const ImageId image : inputs) out.unavoidable += area(image) * bytes_per_pixel(image);
  out.unavoidable += area(graph.result) * bytes_per_pixel(graph.result);
  return out;
}

}  // namespace afterglow
