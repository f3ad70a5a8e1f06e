// SPDX-License-Identifier: MIT
#include "graph/condition.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "graph/history.h"
#include "graph/remove.h"

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
  for (const auto& history : graph.histories) read[history.next] = true;
  for (std::size_t i = graph.passes.size(); i-- > 0;) {
    if (!read[graph.passes[i].output]) continue;
    out[i] = true;
    for (const ImageId image : images_read(graph, graph.passes[i])) read[image] = true;
  }
  return out;
}

void replace_images(Graph& graph, const std::vector<ImageId>& by) {
  for (auto& pass : graph.passes)
    for (auto& input : pass.inputs) input.image = by[input.image];
  for (auto& condition : graph.idle) condition.image = by[condition.image];
  graph.result = by[graph.result];
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
  const auto is_gone = [&](ImageId image) {
    const int producer = graph.images[image].producer;
    return producer >= 0 && gone[producer];
  };
  for (std::size_t i = 0; i < gone.size(); ++i)
    gone[i] = !after[i] && (before[i] || std::ranges::any_of(images_read(out, out.passes[i]), is_gone));
  remove_passes(out, gone);
  separate_result(out);
  return out;
}

int straight_passes(const Graph& graph) {
  return static_cast<int>(std::ranges::count(graph.passes, true, &Pass::straight));
}

Graph without_division(Graph graph) {
  if (const int passes = straight_passes(graph); passes > 0) graph.skipped.push_back(skipped_division(passes));
  for (auto& pass : graph.passes) pass.straight = pass.lights_black = false;
  return graph;
}

Skipped skipped_division(int passes) {
  return {fmt::format("division by alpha in {} {}", passes, passes == 1 ? "pass" : "passes"), "alpha is 1 everywhere"};
}

std::string idle_reason(const IdleCondition& condition) {
  return fmt::format("nothing is brighter than {:.4g}", condition.limit);
}

}  // namespace afterglow
