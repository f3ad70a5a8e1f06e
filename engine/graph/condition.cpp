#include "graph/condition.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace afterglow {
namespace {

/// For each image the one that stands for it when these effects are idle.
std::vector<ImageId> stand_ins(const Graph& graph, const std::vector<bool>& idle) {
  std::vector<ImageId> out(graph.images.size());
  std::iota(out.begin(), out.end(), 0);
  for (std::size_t i = 0; i < graph.idle.size(); ++i)
    if (idle[i]) out[graph.idle[i].output] = out[graph.idle[i].image];
  return out;
}

std::vector<bool> read_passes(const Graph& graph) {
  std::vector<bool> read(graph.images.size(), false), out(graph.passes.size(), false);
  read[graph.result] = true;
  for (std::size_t i = graph.passes.size(); i-- > 0;) {
    if (!read[graph.passes[i].output]) continue;
    out[i] = true;
    for (const auto& input : graph.passes[i].inputs) read[input.image] = true;
  }
  return out;
}

void replace_images(Graph& graph, const std::vector<ImageId>& by) {
  for (auto& pass : graph.passes)
    for (auto& input : pass.inputs) input.image = by[input.image];
  for (auto& condition : graph.idle) condition.image = by[condition.image];
  graph.result = by[graph.result];
}

/// Takes passes out, with the images they make, and numbers the rest anew.
void remove_passes(Graph& graph, const std::vector<bool>& remove) {
  std::vector<ImageId> image_number(graph.images.size(), kNoImage);
  std::vector<int> pass_number(graph.passes.size(), -1);
  int passes = 0;
  for (std::size_t i = 0; i < graph.passes.size(); ++i)
    if (!remove[i]) pass_number[i] = passes++;
  std::vector<GraphImage> images;
  for (std::size_t i = 0; i < graph.images.size(); ++i) {
    GraphImage& image = graph.images[i];
    if (image.producer >= 0 && (image.producer = pass_number[image.producer]) < 0) continue;
    image_number[i] = static_cast<ImageId>(images.size());
    images.push_back(std::move(image));
  }
  graph.images = std::move(images);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < remove.size(); ++i)
    if (!remove[i]) std::swap(graph.passes[kept++], graph.passes[i]);
  graph.passes.resize(kept);

  for (auto& pass : graph.passes) pass.output = image_number[pass.output];
  for (auto& [name, id] : graph.auxiliary) id = image_number[id];
  graph.source = image_number[graph.source];
  for (auto& condition : graph.idle) condition.output = image_number[condition.output];
  std::erase_if(graph.idle, [](const IdleCondition& condition) { return condition.output == kNoImage; });
  replace_images(graph, image_number);
}

}  // namespace

std::vector<bool> idle_effects(const Graph& graph, float brightest) {
  std::vector<bool> is_source(graph.images.size(), false), out;
  is_source[graph.source] = true;
  for (const auto& condition : graph.idle) {
    const bool idle = is_source[condition.image] && brightest <= static_cast<float>(condition.limit);
    if (idle) is_source[condition.output] = true;
    out.push_back(idle);
  }
  return out;
}

Graph without_idle(const Graph& graph, const std::vector<bool>& idle) {
  Graph out = graph;
  const std::vector<bool> before = read_passes(out);
  replace_images(out, stand_ins(graph, idle));
  for (std::size_t i = 0; i < idle.size(); ++i)
    if (idle[i]) out.skipped.push_back({graph.idle[i].effect, idle_reason(graph.idle[i])});
  const std::vector<bool> after = read_passes(out);
  std::vector<bool> gone(after.size());
  // Passes that nobody read before stay where they can: the plan drops and reports them.
  const auto is_gone = [&](const PassInput& input) {
    const int producer = graph.images[input.image].producer;
    return producer >= 0 && gone[producer];
  };
  for (std::size_t i = 0; i < gone.size(); ++i)
    gone[i] = !after[i] && (before[i] || std::ranges::any_of(out.passes[i].inputs, is_gone));
  remove_passes(out, gone);
  return out;
}

std::string idle_reason(const IdleCondition& condition) {
  return fmt::format("nothing is brighter than {:.4g}", condition.limit);
}

}  // namespace afterglow
