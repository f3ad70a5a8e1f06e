#include "graph/plan.h"

#include <algorithm>
#include <map>

#include "graph/history.h"

namespace afterglow {
namespace {

// A fragment stage may use 16 sampled images on any Vulkan device.
constexpr std::size_t kMaxImagesPerKernel = 16;

std::vector<bool> passes_that_matter(const Graph& graph) {
  std::vector<bool> read(graph.images.size(), false), keep(graph.passes.size(), false);
  read[graph.result] = true;
  for (const auto& history : graph.histories) read[history.next] = true;
  for (int i = static_cast<int>(graph.passes.size()) - 1; i >= 0; --i) {
    if (!read[graph.passes[i].output]) continue;
    keep[i] = true;
    for (const ImageId image : images_read(graph, graph.passes[i])) read[image] = true;
  }
  return keep;
}

std::vector<int> count_readers(const Graph& graph, const std::vector<bool>& keep) {
  std::vector<int> readers(graph.images.size(), 0);
  ++readers[graph.result];                                              // whoever runs the graph
  for (const auto& history : graph.histories) ++readers[history.next];  // the next frame
  for (std::size_t i = 0; i < graph.passes.size(); ++i)
    if (keep[i])
      for (const ImageId image : images_read(graph, graph.passes[i])) ++readers[image];
  return readers;
}

// Images that a kernel binds: all inputs of its first pass, of the others all but the colour that flows through.
std::size_t bound_images(const Graph& graph, const PlanKernel& kernel) {
  std::size_t count = 0;
  for (const int pass : kernel.passes) count += graph.passes[pass].inputs.size();
  return count - (kernel.passes.size() - 1);
}

class Joiner {
 public:
  Joiner(const Graph& graph, const std::vector<bool>& keep)
      : graph_(graph), readers_(count_readers(graph, keep)), kernel_of_(graph.images.size(), -1) {}

  void add(int index, Joining joining) {
    const Pass& pass = graph_.passes[index];
    PlanKernel kernel{{index}, pass.name, pass.output};
    const int feeder = pass.kind == PassKind::pixel ? feeder_of(pass, joining) : -1;
    if (feeder >= 0) {
      // The joined kernel runs where its last pass stood, so that everything its later passes read is there.
      PlanKernel& first = kernels_[feeder];
      kernel.passes.insert(kernel.passes.begin(), first.passes.begin(), first.passes.end());
      kernel.name = first.name + "+" + pass.name;
      first.passes.clear();
    }
    kernels_.push_back(std::move(kernel));
    kernel_of_[pass.output] = static_cast<int>(kernels_.size()) - 1;
  }

  std::vector<PlanKernel> finish() {
    std::erase_if(kernels_, [](const PlanKernel& k) { return k.passes.empty(); });
    return std::move(kernels_);
  }

 private:
  // The kernel that makes the colour of this pixel pass, when nobody else reads that image; -1: none.
  int feeder_of(const Pass& pass, Joining joining) const {
    if (joining == Joining::none) return -1;
    const ImageId color = pass.inputs.front().image;
    const int feeder = kernel_of_[color];
    if (feeder < 0 || readers_[color] != 1) return -1;
    if (joining == Joining::heads && !is_head_of(kernels_[feeder], pass)) return -1;
    if (bound_images(graph_, kernels_[feeder]) + pass.inputs.size() - 1 > kMaxImagesPerKernel) return -1;
    return feeder;
  }

  bool is_head_of(const PlanKernel& kernel, const Pass& pass) const {
    const Pass& head = graph_.passes[kernel.passes.front()];
    return kernel.passes.size() == 1 && head.kind == PassKind::filter && head.effect == pass.effect;
  }

  const Graph& graph_;
  std::vector<int> readers_;
  std::vector<int> kernel_of_;  // image → kernel that ends with it
  std::vector<PlanKernel> kernels_;
};

void find_lifetimes(const Graph& graph, Plan& plan) {
  std::map<ImageId, std::size_t> place_of;
  for (std::size_t k = 0; k < plan.kernels.size(); ++k) {
    const int now = static_cast<int>(k);
    for (const int pass : plan.kernels[k].passes)
      for (const ImageId image : images_read(graph, graph.passes[pass]))
        if (const auto it = place_of.find(image); it != place_of.end()) plan.lifetimes[it->second].last = now;
    place_of[plan.kernels[k].output] = plan.transient.size();
    plan.transient.push_back(plan.kernels[k].output);
    plan.lifetimes.push_back({now, now});
  }
  const int end = static_cast<int>(plan.kernels.size()) - 1;
  if (const auto it = place_of.find(graph.result); it != place_of.end()) plan.lifetimes[it->second].last = end;
  for (const auto& history : graph.histories)
    if (const auto it = place_of.find(history.next); it != place_of.end()) plan.lifetimes[it->second].last = end;
}

}  // namespace

Plan make_plan(const Graph& graph, const ExecutionConfig& config) {
  Plan plan;
  const std::vector<bool> keep = passes_that_matter(graph);
  Joiner joiner(graph, keep);
  for (std::size_t i = 0; i < graph.passes.size(); ++i) {
    if (keep[i])
      joiner.add(static_cast<int>(i), config.joining);
    else
      plan.skipped.push_back({graph.passes[i].name, "nobody reads its image"});
  }
  plan.kernels = joiner.finish();
  find_lifetimes(graph, plan);
  return plan;
}

}  // namespace afterglow
