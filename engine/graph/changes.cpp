// SPDX-License-Identifier: MIT
#include "graph/changes.h"

#include <algorithm>
#include <map>

#include "graph/history.h"

namespace afterglow {
namespace {

/// The images that a kernel finds ready: not those which its own passes hand on.
std::vector<ImageId> read_by(const Graph& graph, const PlanKernel& kernel) {
  std::vector<ImageId> out;
  for (const int pass : kernel.passes)
    for (const ImageId image : images_read(graph, graph.passes[pass]))
      if (std::ranges::find(kernel.passes, graph.images[image].producer) == kernel.passes.end()) out.push_back(image);
  return out;
}

}  // namespace

std::vector<Hash> content_keys(const Graph& graph, const Plan& plan, const std::vector<Hash>& own,
                               const std::function<Hash(ImageId)>& brought) {
  std::vector<Hash> keys;
  std::map<ImageId, Hash> made;
  for (std::size_t k = 0; k < plan.kernels.size(); ++k) {
    Hasher hasher;
    hasher.add(own[k].high).add(own[k].low);
    for (const ImageId image : read_by(graph, plan.kernels[k])) {
      const auto found = made.find(image);
      const Hash read = found != made.end() ? found->second : brought(image);
      hasher.add(read.high).add(read.low);
    }
    keys.push_back(hasher.finish());
    made[plan.kernels[k].output] = keys.back();
  }
  return keys;
}

std::vector<bool> kernels_to_run(const Graph& graph, const Plan& plan, const std::vector<bool>& stale) {
  std::vector<bool> wanted(graph.images.size(), false), run(plan.kernels.size(), false);
  wanted[graph.result] = true;
  for (const auto& history : graph.histories) wanted[history.next] = true;
  for (std::size_t k = plan.kernels.size(); k-- > 0;) {
    run[k] = stale[k] && wanted[plan.kernels[k].output];
    if (!run[k]) continue;
    for (const ImageId image : read_by(graph, plan.kernels[k])) wanted[image] = true;
  }
  return run;
}

}  // namespace afterglow
