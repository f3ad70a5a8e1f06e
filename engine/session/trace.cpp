// SPDX-License-Identifier: MIT
#include "session/trace.h"

#include <fmt/format.h>

#include <cmath>

#include "core/half.h"
#include "session/picture_inputs.h"

namespace afterglow {
namespace {

/// The pass that mends `image`; its own image is the next one.
Pass guard_of(const Graph& graph, ImageId image, NanPolicy policy) {
  Pass pass;
  pass.name = graph.images[image].name + " (finite)";
  pass.effect = "output";
  const bool neighbours = policy == NanPolicy::neighbour;
  pass.kind = neighbours ? PassKind::sample : PassKind::pixel;
  pass.shader = neighbours ? "output/finite_neighbours" : "output/finite";
  pass.inputs = {{"source", image, !neighbours}};
  if (neighbours) pass.reach = kNeighbourReach;
  return pass;
}

/// Appends a pass whose image is stored as `like`; returns its image.
ImageId append(Graph& graph, Pass pass, const GraphImage& like) {
  pass.output = static_cast<ImageId>(graph.images.size());
  GraphImage image = like;
  image.name = pass.name;
  image.producer = static_cast<int>(graph.passes.size());
  graph.images.push_back(std::move(image));
  graph.passes.push_back(std::move(pass));
  return graph.passes.back().output;
}

/// `image` of the part that was made; outside it is what it was.
NonFinite find_in(const Image& image, const Rect& part) {
  NonFinite found;
  for (int y = part.y; y < part.y + part.height; ++y)
    note_non_finite(image.at(part.x, y), image.channels, part.width, y, found);
  if (found.first) found.first->x += part.x;
  return found;
}

std::optional<PassOverflow> overflow_in(const Image& image, const Rect& part) {
  PassOverflow out;
  for (int y = part.y; y < part.y + part.height; ++y)
    for (int x = part.x; x < part.x + part.width; ++x) {
      const float* pixel = image.at(x, y);
      std::uint64_t over = 0;
      for (int c = 0; c < 3; ++c) over += std::isfinite(pixel[c]) && std::abs(pixel[c]) > kMaxHalf;
      if (over > 0 && out.samples == 0) out.first = {x, y, 4, {pixel[0], pixel[1], pixel[2], pixel[3]}};
      out.samples += over;
    }
  return out.samples > 0 ? std::optional(out) : std::nullopt;
}

}  // namespace

std::string finding_text(const PassFinding& finding) {
  const bool history = finding.pass.starts_with("history ");
  std::string out = history ? fmt::format("{} holds {}", finding.pass, finding.found.text())
                            : fmt::format("pass '{}' made {}", finding.pass, finding.found.text());
  out += fmt::format(", first at {} of {}x{}", finding.found.first->text(), finding.size.width, finding.size.height);
  if (!finding.shader.empty()) out += fmt::format(" (shader {})", finding.shader);
  return out;
}

void set_places(std::vector<PassFinding>& findings, const Picture& picture) {
  for (PassFinding& finding : findings) {
    if (finding.size != picture.color.size()) continue;
    finding.found.first->x += picture.data_window.x - picture.display_window.x;
    finding.found.first->y += picture.data_window.y - picture.display_window.y;
  }
}

GuardedGraph guard(const Graph& graph, NanPolicy policy) {
  GuardedGraph out;
  Graph& made = out.graph;
  made = graph;
  made.passes.clear();
  made.idle.clear();  // what has nothing to do makes nothing that is not finite either
  std::vector<ImageId> mended(graph.images.size());
  for (std::size_t i = 0; i < mended.size(); ++i) mended[i] = static_cast<ImageId>(i);
  for (const Pass& from : graph.passes) {
    Pass pass = from;
    for (auto& input : pass.inputs) input.image = mended[static_cast<std::size_t>(input.image)];
    made.images[pass.output].producer = static_cast<int>(made.passes.size());
    made.passes.push_back(std::move(pass));
    out.made.push_back(from.output);
    mended[static_cast<std::size_t>(from.output)] =
        append(made, guard_of(graph, from.output, policy), graph.images[from.output]);
  }
  made.result = mended[static_cast<std::size_t>(graph.result)];
  for (auto& history : made.histories) {
    history.next = mended[static_cast<std::size_t>(history.next)];
    if (history.first != kNoImage) history.first = mended[static_cast<std::size_t>(history.first)];
  }
  return out;
}

struct Tracer::State {
  State(Device& device_in, std::uint64_t max_memory_in) : device(device_in), max_memory(max_memory_in) {}
  Device& device;
  std::uint64_t max_memory;
  GuardedGraph guarded;
  std::optional<Rect> region;
  std::unique_ptr<Program> program;
  std::unique_ptr<Renderer> renderer;  // last: it waits before the program goes

  Result<void> prepare(Stack& stack, GuardedGraph wanted, const std::optional<Rect>& part);
  Result<std::optional<Image>> image(ImageId id);
  Result<void> look(Stack& stack, const Graph& graph, Trace& trace);
};

Tracer::Tracer(Device& device, std::uint64_t max_memory) : state_(std::make_unique<State>(device, max_memory)) {}
Tracer::~Tracer() = default;

Result<void> Tracer::State::prepare(Stack& stack, GuardedGraph wanted, const std::optional<Rect>& part) {
  const bool reusable = program && region == part && same_structure(guarded.graph, wanted.graph) &&
                        stack.programs()->can_use_again(*program);
  guarded = std::move(wanted);
  region = part;
  if (!renderer) {
    AFTERGLOW_TRY(renderer, Renderer::create(device, {.max_memory = max_memory}));
  }
  if (reusable) {
    return program->set_parameters(guarded.graph);
  }
  program.reset();
  AFTERGLOW_TRY(program, stack.programs()->by_passes(guarded.graph, part, stack.shaders()));
  return {};
}

/// Empty for what no pass made in the end.
Result<std::optional<Image>> Tracer::State::image(ImageId id) {
  const auto transient = program->transient(id);
  if (!transient || !transient->kept) return std::optional<Image>();
  AFTERGLOW_TRY(HostResult read, renderer->read_image(*program, id));
  Image out;
  out.width = transient->binding.size.width;
  out.height = transient->binding.size.height;
  out.channels = 4;
  out.pixels = std::move(read.pixels);
  return std::optional(std::move(out));
}

Result<void> Tracer::State::look(Stack& stack, const Graph& graph, Trace& trace) {
  for (const auto& history : graph.histories) {
    if (!program->has_previous(history.name)) continue;
    AFTERGLOW_TRY(const auto read, image(history.previous));
    if (!read) continue;
    const NonFinite found = find_in(*read, {0, 0, read->width, read->height});
    if (found.count() > 0)
      trace.passes.push_back({"history " + history.name, history.effect, {}, 0, {}, read->size(), found});
  }
  for (std::size_t i = 0; i < graph.passes.size(); ++i) {
    const Pass& pass = graph.passes[i];
    AFTERGLOW_TRY(const auto read, image(guarded.made[i]));
    if (!read) continue;
    const Rect part = program->parts().images[guarded.made[i]];
    const NonFinite found = find_in(*read, part);
    if (found.count() > 0)
      trace.passes.push_back(
          {pass.name, pass.effect, pass.file, pass.line, stack.shader_file(pass.shader).string(), read->size(), found});
    if (auto overflow = overflow_in(*read, part)) {
      overflow->pass = pass.name;
      overflow->effect = pass.effect;
      trace.overflows.push_back(std::move(*overflow));
    }
  }
  return {};
}

Result<Trace> Tracer::run(Stack& stack, const Picture& picture, const FrameRequest& request, NanPolicy policy) {
  Trace trace;
  AFTERGLOW_TRY(const FrameWork work, stack.work({.build = request.build}));
  const Graph& graph = work.graph;
  trace.result = picture.color;
  if (graph.result == graph.source) return trace;
  AFTERGLOW_CHECK(state_->prepare(stack, guard(graph, policy), request.region));
  const auto inputs = picture_inputs(picture, graph);
  HostResult result;
  result.pixels = std::move(trace.result.pixels);
  result.keep_alpha = true;
  AFTERGLOW_CHECK(state_->renderer->run(*state_->program, inputs, result));
  trace.result.pixels = std::move(result.pixels);
  AFTERGLOW_CHECK(state_->look(stack, graph, trace));
  return trace;
}

}  // namespace afterglow
