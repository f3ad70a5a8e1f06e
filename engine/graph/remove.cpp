// SPDX-License-Identifier: MIT
#include "graph/remove.h"

#include <algorithm>
#include <utility>

namespace afterglow {
namespace {

/// The new number of each pass, -1 for those that go.
std::vector<int> number_passes(const std::vector<bool>& remove) {
  std::vector<int> numbers(remove.size(), -1);
  int next = 0;
  for (std::size_t i = 0; i < remove.size(); ++i)
    if (!remove[i]) numbers[i] = next++;
  return numbers;
}

/// Takes images out; the new number of each, kNoImage for those that go.
std::vector<ImageId> remove_images(Graph& graph, const std::vector<int>& pass_numbers,
                                   const std::vector<bool>& remove) {
  std::vector<ImageId> numbers(graph.images.size(), kNoImage);
  std::vector<GraphImage> kept;
  for (std::size_t i = 0; i < graph.images.size(); ++i) {
    GraphImage& image = graph.images[i];
    if (!remove.empty() && remove[i]) continue;
    if (image.producer >= 0 && (image.producer = pass_numbers[image.producer]) < 0) continue;
    numbers[i] = static_cast<ImageId>(kept.size());
    kept.push_back(std::move(image));
  }
  graph.images = std::move(kept);
  return numbers;
}

}  // namespace

void remove_passes(Graph& graph, const std::vector<bool>& passes, const std::vector<bool>& images) {
  const std::vector<ImageId> number = remove_images(graph, number_passes(passes), images);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < passes.size(); ++i)
    if (!passes[i]) std::swap(graph.passes[kept++], graph.passes[i]);
  graph.passes.resize(kept);
  for (auto& pass : graph.passes) {
    pass.output = number[pass.output];
    for (auto& input : pass.inputs) input.image = number[input.image];
  }
  for (auto& [name, id] : graph.auxiliary) id = number[id];
  graph.source = number[graph.source];
  graph.result = number[graph.result];
  for (auto& condition : graph.idle) {
    condition.output = number[condition.output];
    condition.image = number[condition.image];
  }
  // Nobody asks for the condition of what is gone; and what reads nothing of its source is never idle.
  std::erase_if(graph.idle, [](const IdleCondition& condition) {
    return condition.output == kNoImage || condition.image == kNoImage;
  });
  for (auto& history : graph.histories) {
    history.previous = number[history.previous];
    history.next = number[history.next];
    if (history.first != kNoImage) history.first = number[history.first];
  }
}

}  // namespace afterglow
