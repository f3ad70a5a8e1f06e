// SPDX-License-Identifier: MIT
#include "graph/history.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "graph/remove.h"

namespace afterglow {
namespace {

bool makes(const Graph& graph, const std::string& effect, ImageId image) {
  const int producer = graph.images[image].producer;
  return producer >= 0 && graph.passes[producer].effect == effect;
}

/// The passes of the history's effect that its images are made by, parallel to the graph's.
std::vector<bool> passes_of_part(const Graph& graph, const History& history) {
  std::vector<bool> part(graph.passes.size(), false);
  std::vector<ImageId> wanted{history.next};
  if (history.first != kNoImage) wanted.push_back(history.first);
  while (!wanted.empty()) {
    const ImageId image = wanted.back();
    wanted.pop_back();
    if (!makes(graph, history.effect, image) || part[graph.images[image].producer]) continue;
    part[graph.images[image].producer] = true;
    for (const auto& input : graph.passes[graph.images[image].producer].inputs) wanted.push_back(input.image);
  }
  return part;
}

/// The passes that make these images and what they read. A `previous` that is read needs its `next` in the frame
/// before.
std::vector<bool> passes_for(const Graph& graph, std::vector<ImageId> wanted) {
  std::vector<bool> read(graph.images.size(), false), needed(graph.passes.size(), false);
  while (!wanted.empty()) {
    const ImageId image = wanted.back();
    wanted.pop_back();
    if (image == kNoImage || read[image]) continue;
    read[image] = true;
    if (const History* history = history_of_previous(graph, image)) wanted.push_back(history->next);
    const int producer = graph.images[image].producer;
    if (producer < 0) continue;
    needed[producer] = true;
    for (const ImageId input : images_read(graph, graph.passes[producer])) wanted.push_back(input);
  }
  return needed;
}

}  // namespace

std::string unused_name(const Graph& graph, const std::string& wanted) {
  const auto is_used = [&](const std::string& name) {
    return std::ranges::find(graph.passes, name, &Pass::name) != graph.passes.end() ||
           std::ranges::find(graph.images, name, &GraphImage::name) != graph.images.end();
  };
  std::string name = wanted;
  for (int n = 2; is_used(name); ++n) name = fmt::format("{}#{}", wanted, n);
  return name;
}

const History* history_of_previous(const Graph& graph, ImageId image) {
  const auto found = std::ranges::find(graph.histories, image, &History::previous);
  return found == graph.histories.end() ? nullptr : &*found;
}

const History* history_of_next(const Graph& graph, ImageId image) {
  const auto found = std::ranges::find(graph.histories, image, &History::next);
  return found == graph.histories.end() ? nullptr : &*found;
}

bool is_precise(const Graph& graph, ImageId image) {
  if (image == graph.result) return false;
  for (const auto& history : graph.histories)
    if (history.previous == image || history.next == image) return history.precise;
  return graph.images[image].precise;
}

std::vector<ImageId> images_read(const Graph& graph, const Pass& pass) {
  std::vector<ImageId> out;
  for (const auto& input : pass.inputs) {
    out.push_back(input.image);
    const History* history = history_of_previous(graph, input.image);
    if (history && history->first != kNoImage) out.push_back(history->first);
  }
  return out;
}

void drop_unread_histories(Graph& graph) {
  if (graph.histories.empty()) return;
  const std::vector<bool> needed = passes_for(graph, {graph.result});
  std::vector<bool> read(graph.images.size(), false), remove(graph.passes.size(), false);
  read[graph.result] = true;
  for (std::size_t i = 0; i < graph.passes.size(); ++i)
    if (needed[i])
      for (const auto& input : graph.passes[i].inputs) read[input.image] = true;
  std::vector<bool> unread(graph.images.size(), false);
  for (const auto& history : graph.histories) {
    if (read[history.previous]) continue;
    graph.skipped.push_back({history.name, "nothing that is shown reads this history"});
    unread[history.previous] = true;
  }
  if (std::ranges::find(unread, true) == unread.end()) return;
  // Readers of a history that is gone go with it; other passes that nobody reads are the plan's to report.
  for (std::size_t i = 0; i < graph.passes.size(); ++i)
    for (const auto& input : graph.passes[i].inputs) {
      const int producer = graph.images[input.image].producer;
      if (unread[input.image] || (producer >= 0 && remove[producer])) remove[i] = true;
    }
  std::erase_if(graph.histories, [&](const History& history) { return !read[history.previous]; });
  remove_passes(graph, remove, unread);
}

void separate_result(Graph& graph) {
  const bool source = graph.result == graph.source && !graph.histories.empty();
  const History* kept = history_of_next(graph, graph.result);
  // What is cut off behind the result goes, unless a history needs it.
  const bool read = !graph.histories.empty() && std::ranges::any_of(graph.passes, [&](const Pass& pass) {
    const std::vector<ImageId> images = images_read(graph, pass);
    return std::ranges::find(images, graph.result) != images.end();
  });
  const bool computed = is_computed(graph, graph.result);
  // Pictures beside the source, and what the frame before made.
  const bool brought = graph.result != graph.source && graph.images[graph.result].producer < 0;
  if (!source && !kept && !read && !computed && !brought) return;
  const History* earlier = history_of_previous(graph, graph.result);
  copy_result(graph, kept       ? kept->effect
                     : earlier  ? earlier->effect
                     : computed ? graph.passes[graph.images[graph.result].producer].effect
                     : brought  ? graph.images[graph.result].name
                                : graph.histories.front().effect);
}

void copy_result(Graph& graph, const std::string& effect) {
  Pass copy;
  copy.effect = effect;
  copy.name = unused_name(graph, copy.effect + ".result");
  copy.kind = PassKind::filter;
  copy.filter.interpolation = Interpolation::nearest;
  copy.inputs = {{"source", graph.result, false}};
  copy.output = static_cast<ImageId>(graph.images.size());
  graph.images.push_back({copy.name, graph.images[graph.result].size, static_cast<int>(graph.passes.size())});
  graph.result = copy.output;
  graph.passes.push_back(std::move(copy));
}

int pre_roll(const Graph& graph) {
  std::map<std::string, int> of_effect;
  for (const auto& history : graph.histories)
    of_effect[history.effect] = std::max(of_effect[history.effect], history.pre_roll);
  int sum = 0;
  for (const auto& [effect, frames] : of_effect) sum += frames;
  return sum;
}

Hash history_part(const Graph& graph, const History& history) {
  Hasher hasher;
  const auto add_image = [&](ImageId id) {
    const GraphImage& image = graph.images[id];
    const bool own = makes(graph, history.effect, id);
    // Effects before this one may change: their pictures flow through the same images.
    hasher.add(own || history_of_previous(graph, id) ? image.name : "from outside");
    hasher.add(static_cast<std::uint64_t>(image.size.width)).add(static_cast<std::uint64_t>(image.size.height));
    hasher.add(static_cast<std::uint64_t>(image.channels));
  };
  hasher.add(history.name).add(static_cast<std::uint64_t>(history.precise));
  add_image(history.previous);
  add_image(history.next);
  if (history.first != kNoImage) add_image(history.first);
  const std::vector<bool> part = passes_of_part(graph, history);
  for (std::size_t i = 0; i < part.size(); ++i) {
    if (!part[i]) continue;
    const Pass& pass = graph.passes[i];
    // The numbers of a filter are values, as parameters are: what it made is still what it makes.
    hasher.add(pass.name).add(pass.shader).add(pass.by_workgroups).add(static_cast<std::uint64_t>(pass.kind));
    for (const auto& [name, value] : pass.constants) hasher.add(name).add(fmt::format("{}", value));
    for (const auto& input : pass.inputs) hasher.add(input.name), add_image(input.image);
  }
  return hasher.finish();
}

}  // namespace afterglow
