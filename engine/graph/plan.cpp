// SPDX-License-Identifier: MIT
#include "graph/plan.h"

#include <algorithm>
#include <map>
#include <utility>

#include "graph/history.h"

namespace afterglow {
namespace {

// A fragment stage may use 16 sampled images on any Vulkan device.
constexpr std::size_t kMaxImagesPerKernel = 16;
// Drivers take more than twice as long to compile a kernel of twice the length, and shader/weight.h has a limit for it.
// An image more is soon stored and read.
constexpr std::size_t kMaxPassesPerKernel = 24;

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

// Whoever runs the graph gives the result's image, and the frame before that of a history: both are drawn to.
bool must_be_drawn(const Graph& graph, ImageId image) {
  return image == graph.result || history_of_next(graph, image) != nullptr;
}

int param_bytes(const Graph& graph, const PlanKernel& kernel) {
  int bytes = 0;
  for (const int pass : kernel.passes)
    for (const auto& [name, value] : graph.passes[static_cast<std::size_t>(pass)].params)
      bytes += block_bytes(value.type, value.elements);
  return bytes;
}

// Images that no frame changes, by the passes that make them: nothing of the source, of an auxiliary image or of a
// frame before flows into them. Who runs the graph takes the result anew in every frame, and a history its next image.
std::vector<bool> made_once(const Graph& graph) {
  std::vector<bool> once(graph.images.size(), false);
  for (std::size_t i = 0; i < graph.images.size(); ++i) once[i] = graph.images[i].data != nullptr;
  for (const auto& pass : graph.passes)
    once[pass.output] = !must_be_drawn(graph, pass.output) &&
                        std::ranges::all_of(images_read(graph, pass), [&](ImageId read) { return once[read]; });
  return once;
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

std::string name_of(const Graph& graph, const std::vector<int>& passes) {
  std::string name;
  for (const int of : passes) name += (name.empty() ? "" : "+") + graph.passes[of].name;
  return name;
}

bool is_anchor(const Pass& pass) { return info_of(pass.kind).begins; }

bool runs_as_workgroups(const Graph& graph, const PlanKernel& kernel, const ExecutionConfig& config) {
  const Pass& anchor = graph.passes[kernel.passes.front()];
  if (anchor.kind == PassKind::compute) return true;
  return config.compute && !anchor.by_workgroups.empty() && !must_be_drawn(graph, kernel.output);
}

// Images that a kernel binds: those that its passes do not hand on to each other, each once where it is read at the own
// pixel.
std::size_t bound_images(const Graph& graph, const PlanKernel& kernel) {
  std::size_t count = 0;
  std::vector<ImageId> own;
  for (const int index : kernel.passes)
    for (const auto& input : graph.passes[index].inputs) {
      const int producer = graph.images[input.image].producer;
      if (std::ranges::find(kernel.passes, producer) != kernel.passes.end()) continue;
      if (!reads_own_pixel(graph.passes[index], input)) {
        ++count;
      } else if (std::ranges::find(own, input.image) == own.end()) {
        own.push_back(input.image);
      }
    }
  return count + own.size();
}

// Passes are taken in order; each begins a kernel of its own and draws in those that make what it reads, as soon as all
// readers of an image stand in one kernel.
class Joiner {
 public:
  Joiner(const Graph& graph, const std::vector<bool>& keep, const std::vector<bool>& once)
      : graph_(graph), once_(once), readers_(count_readers(graph, keep)), kernel_of_(graph.images.size(), -1) {}

  void add(int index, Fusion fusion) {
    const Pass& pass = graph_.passes[index];
    PlanKernel kernel{{index}, "", pass.output};
    if (fusion != Fusion::none && pass.kind == PassKind::pixel)
      for (int feeder = feeder_of(kernel, fusion); feeder >= 0; feeder = feeder_of(kernel, fusion))
        kernel = fused(kernels_[feeder], kernel);
    kernel.name = name_of(graph_, kernel.passes);
    // It runs where its last pass stands, so that everything that its passes read is there.
    kernels_.push_back(std::move(kernel));
    kernel_of_[pass.output] = static_cast<int>(kernels_.size()) - 1;
  }

  std::vector<PlanKernel> finish() {
    std::erase_if(kernels_, [](const PlanKernel& k) { return k.passes.empty(); });
    return std::move(kernels_);
  }

 private:
  // A kernel whose image is read by passes of this one alone, each at its own pixel; -1: none that may join.
  int feeder_of(const PlanKernel& kernel, Fusion fusion) const {
    for (const int index : kernel.passes)
      for (const auto& input : graph_.passes[index].inputs) {
        const int feeder = kernel_of_[input.image];
        if (feeder < 0 || kernels_[feeder].passes.empty() || !reads_own_pixel(graph_.passes[index], input)) continue;
        if (own_readers(kernel, input.image) != readers_[input.image]) continue;
        if (once_[input.image] && !once_[kernel.output]) continue;  // one read a frame instead of all that makes it
        if (fusion == Fusion::filters && !is_anchor_of(kernels_[feeder], kernel)) continue;
        if (is_anchor(first(kernel)) && is_anchor(first(kernels_[feeder]))) continue;
        if (first(kernels_[feeder]).kind == PassKind::compute && must_be_drawn(graph_, kernel.output)) continue;
        PlanKernel both{kernel.passes, "", kernel.output};
        both.passes.insert(both.passes.end(), kernels_[feeder].passes.begin(), kernels_[feeder].passes.end());
        if (both.passes.size() <= kMaxPassesPerKernel && bound_images(graph_, both) <= kMaxImagesPerKernel &&
            param_bytes(graph_, both) <= kMostParamBytes)
          return feeder;
      }
    return -1;
  }

  const Pass& first(const PlanKernel& kernel) const { return graph_.passes[kernel.passes.front()]; }

  int own_readers(const PlanKernel& kernel, ImageId image) const {
    int count = 0;
    for (const int index : kernel.passes)
      for (const auto& input : graph_.passes[index].inputs)
        count += input.image == image && reads_own_pixel(graph_.passes[index], input);
    return count;
  }

  bool is_anchor_of(const PlanKernel& feeder, const PlanKernel& kernel) const {
    return feeder.passes.size() == 1 && kernel.passes.size() == 1 && first(feeder).kind == PassKind::filter &&
           first(feeder).effect == first(kernel).effect &&
           first(kernel).inputs.front().image == graph_.passes[feeder.passes.front()].output;
  }

  PlanKernel fused(PlanKernel& feeder, const PlanKernel& kernel) const {
    PlanKernel out{kernel.passes, "", kernel.output};
    out.passes.insert(out.passes.end(), feeder.passes.begin(), feeder.passes.end());
    std::ranges::sort(out.passes, {}, [&](int pass) { return std::pair(!is_anchor(graph_.passes[pass]), pass); });
    feeder.passes.clear();
    return out;
  }

  const Graph& graph_;
  const std::vector<bool>& once_;
  std::vector<int> readers_;
  std::vector<int> kernel_of_;  // image → kernel that ends with it
  std::vector<PlanKernel> kernels_;
};

// Samplers make one row an invocation, and what is joined to them with them. Many pixel passes behind a large one are
// made faster by several rows, even though their image has to be stored and read once more. Half floats would round it.
void cut_behind_samplers(const Graph& graph, const ExecutionConfig& config, std::vector<PlanKernel>& kernels) {
  constexpr std::size_t kMany = 5;
  constexpr long long kLarge = 1 << 19;
  if (config.rows <= 1 || config.storage != Storage::fp32) return;
  std::vector<PlanKernel> cut;
  for (auto& kernel : kernels) {
    const Pass& anchor = graph.passes[kernel.passes.front()];
    PlanKernel tail{{kernel.passes.begin() + 1, kernel.passes.end()}, "", kernel.output};
    const bool gains = anchor.kind == PassKind::sample && tail.passes.size() >= kMany &&
                       graph.images[kernel.output].size.area() >= kLarge;
    if (!gains || bound_images(graph, tail) > kMaxImagesPerKernel) {
      cut.push_back(std::move(kernel));
      continue;
    }
    tail.name = name_of(graph, tail.passes);
    cut.push_back({{kernel.passes.front()}, anchor.name, anchor.output});
    cut.push_back(std::move(tail));
  }
  kernels = std::move(cut);
}

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
  for (std::size_t k = 0; k < plan.kernels.size(); ++k)
    if (plan.once[k]) plan.lifetimes[place_of[plan.kernels[k].output]] = {0, end};
  if (const auto it = place_of.find(graph.result); it != place_of.end()) plan.lifetimes[it->second].last = end;
  for (const auto& history : graph.histories)
    if (const auto it = place_of.find(history.next); it != place_of.end()) plan.lifetimes[it->second].last = end;
}

}  // namespace

bool reads_own_pixel(const Pass& pass, const PassInput& input) {
  return input.pixelwise || (pass.kind == PassKind::pixel && &input == &pass.inputs.front());
}

std::optional<int> value_in(const Graph& graph, const PlanKernel& kernel, ImageId image) {
  const Pass& anchor = graph.passes[kernel.passes.front()];
  const int first_stage = is_anchor(anchor) ? 0 : 1;  // number of the first pass: an anchor makes value 0
  for (std::size_t i = 0; i < kernel.passes.size(); ++i)
    if (graph.passes[kernel.passes[i]].output == image) return static_cast<int>(i) + first_stage;
  if (!is_anchor(anchor) && anchor.inputs.front().image == image) return 0;
  return std::nullopt;
}

Plan make_plan(const Graph& graph, const ExecutionConfig& config, bool stores_result) {
  Plan plan;
  const std::vector<bool> keep = passes_that_matter(graph), once = made_once(graph);
  Joiner joiner(graph, keep, once);
  for (std::size_t i = 0; i < graph.passes.size(); ++i) {
    if (keep[i])
      joiner.add(static_cast<int>(i), config.fusion);
    else
      plan.skipped.push_back({graph.passes[i].name, "nobody reads its image"});
  }
  plan.kernels = joiner.finish();
  cut_behind_samplers(graph, config, plan.kernels);
  for (auto& kernel : plan.kernels) {
    kernel.workgroups = runs_as_workgroups(graph, kernel, config);
    const bool may_store = stores_result || kernel.output != graph.result;
    kernel.dispatched = kernel.workgroups || (config.dispatched && may_store);
  }
  for (const auto& kernel : plan.kernels) plan.once.push_back(once[kernel.output]);
  find_lifetimes(graph, plan);
  return plan;
}

}  // namespace afterglow
