// SPDX-License-Identifier: MIT
#include "stress/harness.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/oracle.h"
#include "exec/calibration.h"
#include "graph/condition.h"
#include "session/picture_inputs.h"
#include "stress/auxiliary.h"

namespace afterglow::stress {

constexpr long long kMostPixels = 1ll << 24;  ///< of all images of a look together: 256 MiB of full floats

struct Prepared {
  std::unique_ptr<Stack> stack;
  std::unique_ptr<Renderer> renderer;
};

namespace {

BuildContext context_for(Size size, double frame, bool restart = true) {
  BuildContext context{.size = size, .auxiliary = auxiliary_sizes(size)};
  context.frame = frame;
  context.time = (frame - 1) / context.fps;
  context.restart = restart;
  return context;
}

/// What an effect makes of an error of what it gets, and its own, one behind the other: as far as all of them promise
/// it.
std::optional<double> promised_error(const Build& build) {
  constexpr double kBlend = 4;  // screens and overlays of what differs by a little, and masks that look at it
  const auto number = [](const Promises& of, const char* hold, const char* name) -> std::optional<double> {
    const auto found = std::ranges::find(of.invariants, hold, &Invariant::name);
    if (found == of.invariants.end() || !std::isfinite(found->numbers.at(name))) return {};
    return found->numbers.at(name);
  };
  if (build.promise_error || build.promises.size() != build.entries->size()) return {};
  double error = 0;
  for (std::size_t i = 0; i < build.entries->size(); ++i) {
    const StackEntry& entry = (*build.entries)[i];
    if (entry.effect == kGroup) continue;
    if (std::ranges::find(build.graph.skipped, entry.name, &Skipped::name) != build.graph.skipped.end()) continue;
    const auto own = number(build.promises[i], "error", "fp32");
    const auto slope = number(build.promises[i], "continuous", "slope");
    if (!own || (error > 0 && !slope)) return {};
    error = kBlend * (error * std::max(1.0, slope.value_or(1)) + *own);
  }
  return error;
}

/// The source itself, where nothing runs.
Made untouched(const Picture& picture) { return {.image = picture.color}; }

}  // namespace

std::string Way::name() const {
  std::string out = plain ? "plain" : execution_name(choice);
  if (skip_idle) out += ", idle effects left out";
  if (copied) out += ", result copied";
  if (region) out += fmt::format(", region {},{},{},{}", region->x, region->y, region->width, region->height);
  if (!show.empty()) out += ", image " + show;
  return out;
}

struct Harness::State {
  Device* device = nullptr;
  Diagnostics* diagnostics = nullptr;
  std::shared_ptr<SharedKernels> shared;
  std::map<std::string, Prepared> prepared;  ///< by look, way and size
  std::map<std::string, Made> results;       ///< by look, way, frame and content of the picture
  std::map<std::string, Result<LookFacts>> known;
  ExecutionConfig usual;

  StackOptions options(const Look& look, const Way& way) const {
    StackOptions out;
    out.preset.text = look.text();
    out.preset.paths = look.paths;
    out.reference = way.plain;
    if (!way.plain) out.choice = way.choice;
    out.skip_idle = way.skip_idle;
    out.copy_result = way.copied;
    out.shared = shared;
    out.max_memory = 16ull << 30;
    return out;
  }
  Result<Made> run(const Look& look, const Picture& picture, double frame, const Way& way, bool restart = true);
  Result<LookFacts> find_facts(const Look& look, Size size, double frame);
  Result<Prepared*> prepare(const Look& look, const Way& way, const Picture& picture, double frame,
                            bool restart = true);
};

Harness::Harness(std::unique_ptr<State> state) : state_(std::move(state)) {}
Harness::~Harness() = default;
Device& Harness::device() { return *state_->device; }
const ExecutionConfig& Harness::usual() const { return state_->usual; }

Result<std::unique_ptr<Harness>> Harness::create(Device& device, const std::filesystem::path& cache,
                                                 Diagnostics& diagnostics) {
  auto state = std::make_unique<State>();
  state->device = &device;
  state->diagnostics = &diagnostics;
  state->shared = std::make_shared<SharedKernels>(cache.empty() ? cache : cache / "shaders");
  AFTERGLOW_TRY(const Calibration calibration, Calibration::shipped());
  state->usual = calibration.find(device.info(), 0).choice;
  state->usual.storage = Storage::fp32;
  state->usual.hardware_filter = false;
  return std::unique_ptr<Harness>(new Harness(std::move(state)));
}

void Harness::forget() {
  state_->prepared.clear();
  state_->results.clear();
  state_->known.clear();
}

Result<Prepared*> Harness::State::prepare(const Look& look, const Way& way, const Picture& picture, double frame,
                                          bool restart) {
  const Size size = picture.color.size();
  const std::string key = fmt::format("{}\n{}\n{}x{}", look.text(), way.name(), size.width, size.height);
  Prepared& one = prepared[key];
  if (!one.stack) {
    // The file need not exist: the text takes its place, and effects are found along the paths.
    AFTERGLOW_TRY(one.stack, Stack::load("stress.lua", options(look, way), *diagnostics));
    one.stack->use(*device, true);
    one.stack->show(way.show);
    AFTERGLOW_TRY(one.renderer, Renderer::create(*device, {.max_memory = 16ull << 30}));
  }
  AFTERGLOW_CHECK(one.stack->prepare(context_for(size, frame, restart), {}, way.region));
  return &one;
}

Result<Made> Harness::run(const Look& look, const Picture& picture, double frame, const Way& way) {
  if (picture.content.empty()) return state_->run(look, picture, frame, way);
  std::string key = fmt::format("{}\n{}\n{}", look.text(), way.name(), frame);
  for (const auto& [name, hash] : picture.content) key += hash.hex();
  if (const auto found = state_->results.find(key); found != state_->results.end()) return found->second;
  AFTERGLOW_TRY(Made made, state_->run(look, picture, frame, way));
  return state_->results[key] = std::move(made);
}

Result<std::vector<Made>> Harness::run_sequence(const Look& look, const std::vector<Picture>& pictures, double first,
                                                const Way& way) {
  std::vector<Made> out;
  for (const Picture& picture : pictures) {
    const bool begins = out.empty();
    AFTERGLOW_TRY(Made made, state_->run(look, picture, first + static_cast<double>(out.size()), way, begins));
    out.push_back(std::move(made));
  }
  return out;
}

Result<std::map<std::string, Rect>> Harness::read_of_inputs(const Look& look, const Picture& picture, double frame,
                                                            const Way& way) {
  AFTERGLOW_TRY(Prepared* const one, state_->prepare(look, way, picture, frame));
  std::map<std::string, Rect> out;
  if (!one->stack->runs()) return out;
  const Program& program = *one->stack->program();
  const Graph& graph = program.graph();
  const auto& parts = program.parts().images;
  out["source"] = parts[graph.source];
  for (const auto& [name, image] : graph.auxiliary) out[name] = parts[image];
  return out;
}

Result<Made> Harness::State::run(const Look& look, const Picture& picture, double frame, const Way& way, bool restart) {
  AFTERGLOW_TRY(Prepared* const one, prepare(look, way, picture, frame, restart));
  if (!one->stack->runs()) return untouched(picture);
  AFTERGLOW_TRY(RenderRequest request, one->stack->request(request_for(one->stack->build(), {}, way.region)));
  request.inputs = picture_inputs(picture, request.work.graph);
  for (auto& [name, input] : request.inputs) input.content.reset();  // it is to run, whatever ran before
  HostResult result;
  AFTERGLOW_TRY(const FrameReport report, one->renderer->render(std::move(request), result));
  (void)report;
  const Size size = one->stack->program()->graph().images[one->stack->program()->graph().result].size;
  Made made{.image = {}, .clamped = result.clamped, .shown = one->stack->shows()};
  made.image.width = size.width;
  made.image.height = size.height;
  made.image.channels = 4;
  made.image.pixels = std::move(result.pixels);
  return made;
}

Result<std::vector<std::pair<std::string, Image>>> Harness::images(const Look& look, const Picture& picture,
                                                                   double frame) {
  AFTERGLOW_TRY(const Made result, state_->run(look, picture, frame, {.plain = true}));
  AFTERGLOW_TRY(Prepared* const one, state_->prepare(look, {.plain = true}, picture, frame));
  std::vector<std::pair<std::string, Image>> out;
  if (!one->stack->runs()) return out;
  const Graph& graph = one->stack->program()->graph();
  for (const auto& pass : graph.passes) {
    const auto& made = graph.images[static_cast<std::size_t>(pass.output)];
    Image image(made.size.width, made.size.height, 4);
    if (pass.output == graph.result) {
      image = result.image;
    } else if (const auto held = one->stack->program()->transient(pass.output); held && held->kept) {
      AFTERGLOW_TRY(HostResult pixels, one->renderer->read_image(*one->stack->program(), pass.output));
      image.pixels = std::move(pixels.pixels);
    } else {
      continue;  // nobody reads it, so nothing makes it
    }
    out.emplace_back(pass.name, std::move(image));
  }
  return out;
}

Result<LookFacts> Harness::facts(const Look& look, Size size, double frame) {
  const std::string key = fmt::format("{}\n{}x{}\n{}", look.text(), size.width, size.height, frame);
  const auto found = state_->known.find(key);
  return found != state_->known.end() ? found->second
                                      : state_->known.emplace(key, state_->find_facts(look, size, frame)).first->second;
}

Result<LookFacts> Harness::State::find_facts(const Look& look, Size size, double frame) {
  AFTERGLOW_TRY(const auto stack, Stack::load("stress.lua", options(look, {.plain = true}), *diagnostics));
  AFTERGLOW_TRY(const auto build, stack->evaluate(context_for(size, frame)));
  const Graph& graph = build->graph;
  long long pixels = 0;
  for (const auto& image : graph.images) pixels += image.size.area();
  if (pixels > kMostPixels)
    return Error{ErrorKind::io, fmt::format("its images have {} pixels, more than are tried", pixels)};
  LookFacts facts{.entries = bench::oracle_entries(*build),
                  .invariants = {},
                  .runs = graph.result != graph.source,
                  .left_out = graph.skipped.empty() ? "" : graph.skipped.front().reason,
                  .changing = build->changing,
                  .passes = 0,
                  .images = {}};
  facts.passes = graph.passes.size();
  facts.divides = straight_passes(graph) > 0;
  facts.looks_back = !graph.histories.empty();
  for (const auto& pass : graph.passes) {
    const GraphImage& image = graph.images[static_cast<std::size_t>(pass.output)];
    if (pass.output != graph.result && image.size == size) facts.images.push_back(image.name);
  }
  facts.error = promised_error(*build);
  if (build->entries->size() == 1 && !look.is_composed()) {
    if (build->promise_error) return *build->promise_error;
    facts.invariants = build->promises.front().invariants;
  }
  return facts;
}

}  // namespace afterglow::stress
