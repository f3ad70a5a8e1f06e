// SPDX-License-Identifier: MIT
#include "graph/graph.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "graph/history.h"

namespace afterglow {
namespace {

Error pass_error(const Pass& pass, std::string what) {
  return Error{ErrorKind::script, fmt::format("pass '{}' of effect '{}': {}", pass.name, pass.effect, what), pass.file,
               pass.line};
}

bool is_image(const Graph& graph, ImageId id) { return id >= 0 && id < static_cast<ImageId>(graph.images.size()); }

Result<void> validate_images(const Graph& graph) {
  for (const auto& image : graph.images)
    if (image.size.width < 1 || image.size.height < 1)
      return Error{ErrorKind::script,
                   fmt::format("image '{}' has no pixels ({}×{})", image.name, image.size.width, image.size.height)};
  for (std::size_t i = 0; i < graph.images.size(); ++i) {
    const GraphImage& image = graph.images[i];
    const bool made = image.producer >= 0 || history_of_previous(graph, static_cast<ImageId>(i));
    if (image.channels != 4 && !(made && (image.channels == 1 || image.channels == 2)))
      return Error{ErrorKind::script, fmt::format("image '{}' cannot have {} channels", image.name, image.channels)};
  }
  for (const auto& image : graph.images)
    if (image.data && (image.producer >= 0 || image.data->size != image.size ||
                       image.data->pixels.size() != static_cast<std::size_t>(image.size.area()) * 4))
      return Error{ErrorKind::script, fmt::format("image '{}' does not fit the data it is made of", image.name)};
  if (!is_image(graph, graph.source)) return Error{ErrorKind::script, "the graph has no source image"};
  if (!is_image(graph, graph.result)) return Error{ErrorKind::script, "the graph has no result image"};
  return {};
}

Result<void> validate_inputs(const Graph& graph, const Pass& pass, const std::vector<bool>& made) {
  const bool has_source = pass.kind == PassKind::pixel || pass.kind == PassKind::filter;
  if (has_source && (pass.inputs.empty() || pass.inputs.front().name != "source"))
    return pass_error(pass, "its first input is not 'source'");
  const Size target = graph.images[pass.output].size;
  for (const auto& input : pass.inputs) {
    if (!is_image(graph, input.image))
      return pass_error(pass, fmt::format("input '{}' is no image of this graph", input.name));
    const auto& image = graph.images[input.image];
    if (!made[input.image])
      return pass_error(pass, fmt::format("input '{}' reads '{}' before it is made", input.name, image.name));
    if (input.pixelwise && image.size != target)
      return pass_error(pass, fmt::format("input '{}' is {}×{} but is read pixel by pixel into {}×{}", input.name,
                                          image.size.width, image.size.height, target.width, target.height));
  }
  return {};
}

Result<void> validate_conditions(const Graph& graph) {
  for (const auto& condition : graph.idle) {
    const auto wrong = [&](const char* what) {
      return Error{ErrorKind::script, fmt::format("idle of effect '{}': {}", condition.effect, what)};
    };
    if (!is_image(graph, condition.image) || !is_image(graph, condition.output))
      return wrong("it is about no image of this graph");
    if (graph.images[condition.output].producer < 0) return wrong("no pass makes the image that it replaces");
    if (graph.images[condition.image].producer >= graph.images[condition.output].producer)
      return wrong("it looks at an image that is made after the one it replaces");
    if (graph.images[condition.image].size != graph.images[condition.output].size)
      return wrong("the two images have different sizes");
    if (graph.images[condition.image].channels != graph.images[condition.output].channels)
      return wrong("the two images have different channels");
    if (!std::isfinite(condition.limit)) return wrong("its limit is not finite");
  }
  return {};
}

/// Which pass makes each history's next image, which reads its previous one.
Result<void> validate_history(const Graph& graph, const History& history) {
  const auto wrong = [&](const std::string& what) {
    return Error{ErrorKind::script, fmt::format("history '{}' of effect '{}': {}", history.name, history.effect, what)};
  };
  if (!is_image(graph, history.previous) || !is_image(graph, history.next))
    return wrong("it is about no image of this graph");
  const GraphImage &previous = graph.images[history.previous], &next = graph.images[history.next];
  if (previous.producer >= 0 || history.previous == graph.source || history.previous == graph.result)
    return wrong(fmt::format("'{}' cannot be what the frame before made", previous.name));
  if (next.producer < 0) return wrong(fmt::format("no pass makes '{}' for the next frame", next.name));
  if (history.next == graph.result) return wrong("the result cannot be kept for the next frame");
  if (is_computed(graph, history.next)) return wrong("a compute pass cannot make what the next frame gets");
  if (next.size != previous.size)
    return wrong(fmt::format("it is {}×{}, but the next frame gets {}×{}", previous.size.width, previous.size.height,
                             next.size.width, next.size.height));
  if (next.channels > previous.channels)
    return wrong(fmt::format("it has {} channels, but the next frame gets {}", previous.channels, next.channels));
  if (history.pre_roll < 0) return wrong("its pre-roll is negative");
  for (const double value : history.initial)
    if (!std::isfinite(static_cast<float>(value))) return wrong("its first value is not finite");
  if (history.first == kNoImage) return {};
  if (!is_image(graph, history.first)) return wrong("its first image is no image of this graph");
  const GraphImage& first = graph.images[history.first];
  if (previous.channels != 4) return wrong("a first image is for histories of four channels");
  if (first.size != previous.size)
    return wrong(fmt::format("it is {}×{}, but its first image is {}×{}", previous.size.width, previous.size.height,
                             first.size.width, first.size.height));
  if (history_of_previous(graph, history.first)) return wrong("its first image is itself of an earlier frame");
  for (int pass = 0; pass <= first.producer; ++pass)
    for (const auto& input : graph.passes[pass].inputs)
      if (input.image == history.previous)
        return wrong(fmt::format("'{}' is read before its first image is made", previous.name));
  return {};
}

Result<void> validate_histories(const Graph& graph) {
  std::set<std::string> names;
  std::set<ImageId> images;
  for (const auto& history : graph.histories) {
    AFTERGLOW_CHECK(validate_history(graph, history));
    if (!names.insert(history.name).second || !images.insert(history.previous).second ||
        !images.insert(history.next).second)
      return Error{ErrorKind::script, fmt::format("history '{}' of effect '{}': another one has its name or an image "
                                                  "of it",
                                                  history.name, history.effect)};
  }
  return {};
}

bool same_histories(const Graph& a, const Graph& b) {
  return std::ranges::equal(a.histories, b.histories, [](const History& x, const History& y) {
    return x.name == y.name && x.effect == y.effect && x.previous == y.previous && x.next == y.next &&
           x.first == y.first && x.precise == y.precise;
  });
}

bool same_conditions(const Graph& a, const Graph& b) {
  return std::ranges::equal(a.idle, b.idle, [](const IdleCondition& x, const IdleCondition& y) {
    return x.image == y.image && x.output == y.output;
  });
}

}  // namespace

std::vector<std::vector<double>> rows_of(const ParamValue& value) {
  const auto side = static_cast<std::size_t>(matrix_side(value.type));
  if (side == 0) {
    const auto length = static_cast<std::size_t>(component_count(value.type));
    std::vector<std::vector<double>> rows(value.v.size() / length);
    for (std::size_t i = 0; i < rows.size() * length; ++i) rows[i / length].push_back(value.v[i]);
    return rows;
  }
  std::vector<std::vector<double>> rows(side);
  for (std::size_t i = 0; i < value.v.size(); ++i) rows[i % side].push_back(value.v[i]);
  return rows;
}

bool is_computed(const Graph& graph, ImageId image) {
  const int producer = graph.images[image].producer;
  return producer >= 0 && graph.passes[producer].kind == PassKind::compute;
}

std::optional<int> known_channels(const std::string& input) {
  if (input == "depth") return 1;
  if (input == "motion") return 2;
  if (input == "normal") return 3;
  return std::nullopt;
}

int stored_channels(const Graph& graph, ImageId image, const ExecutionConfig& config) {
  if (image == graph.result || config.four_channels) return 4;
  const History* history = history_of_next(graph, image);
  return graph.images[history ? history->previous : image].channels;
}

std::vector<std::string> shaders_of(const Pass& pass) {
  std::vector<std::string> out;
  for (const auto& name : {pass.shader, pass.by_workgroups})
    if (!name.empty()) out.push_back(name);
  return out;
}

Result<void> validate(const Graph& graph) {
  AFTERGLOW_CHECK(validate_images(graph));
  std::vector<bool> made(graph.images.size());
  for (std::size_t i = 0; i < graph.images.size(); ++i) made[i] = graph.images[i].producer < 0;
  std::set<std::string> names;
  for (std::size_t i = 0; i < graph.passes.size(); ++i) {
    const Pass& pass = graph.passes[i];
    if (!names.insert(pass.name).second) return pass_error(pass, "another pass has the same name");
    if (!is_image(graph, pass.output)) return pass_error(pass, "makes no image");
    if (made[pass.output]) return pass_error(pass, fmt::format("writes '{}' again", graph.images[pass.output].name));
    if (graph.images[pass.output].producer != static_cast<int>(i))
      return pass_error(pass, "its image names another producer");
    AFTERGLOW_CHECK(validate_inputs(graph, pass, made));
    made[pass.output] = true;
  }
  if (!made[graph.result])
    return Error{ErrorKind::script, fmt::format("no pass makes the result '{}'", graph.images[graph.result].name)};
  if (is_computed(graph, graph.result))
    return pass_error(graph.passes[graph.images[graph.result].producer], "a compute pass cannot make the result");
  AFTERGLOW_CHECK(validate_conditions(graph));
  return validate_histories(graph);
}

bool same_structure(const Graph& a, const Graph& b) {
  if (a.images.size() != b.images.size() || a.passes.size() != b.passes.size()) return false;
  if (a.source != b.source || a.result != b.result || a.auxiliary != b.auxiliary) return false;
  if (!same_conditions(a, b) || !same_histories(a, b)) return false;
  for (std::size_t i = 0; i < a.images.size(); ++i)
    if (a.images[i].size != b.images[i].size || a.images[i].producer != b.images[i].producer ||
        a.images[i].channels != b.images[i].channels || a.images[i].precise != b.images[i].precise ||
        !a.images[i].data != !b.images[i].data)
      return false;
  for (std::size_t i = 0; i < a.passes.size(); ++i) {
    const Pass &p = a.passes[i], &q = b.passes[i];
    if (p.name != q.name || p.kind != q.kind || p.shader != q.shader || p.by_workgroups != q.by_workgroups ||
        !(p.filter == q.filter) || p.inputs != q.inputs || p.constants != q.constants || p.output != q.output ||
        p.params.size() != q.params.size() || p.straight != q.straight || p.lights_black != q.lights_black)
      return false;
    for (auto x = p.params.begin(), y = q.params.begin(); x != p.params.end(); ++x, ++y)
      if (x->first != y->first || x->second.type != y->second.type || x->second.elements != y->second.elements)
        return false;
  }
  return true;
}

}  // namespace afterglow
