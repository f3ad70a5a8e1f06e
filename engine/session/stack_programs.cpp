#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "core/stopwatch.h"
#include "graph/condition.h"
#include "graph/history.h"
#include "graph/region.h"
#include "session/stack_state.h"

namespace afterglow {

Result<void> Stack::State::fit_histories() {
  const bool half = choice.execution.storage == Storage::fp16 && !options.reference;
  return histories->fit(*device, graph,
                        {.half = half, .storage = choice.execution.storage_reads, .max_memory = options.max_memory});
}

ProgramOptions Stack::State::options_of_programs() const {
  ProgramOptions out = program_options(choice.execution);
  out.reference = options.reference;
  out.source_is_storage = own_images;
  out.result_by_rows = own_images;
  out.codes = encoded;
  out.region = region;
  out.flag_non_finite = options.flag_non_finite;
  out.keep_images = options.keep_images;
  out.max_memory = options.max_memory;
  out.pipelines = &shared->pipelines;
  out.images = &shared->images;
  out.histories = histories;
  return out;
}

Graph Stack::State::graph_of_program() const {
  const bool asked_for_each_frame = own_images && options.skip_idle && !options.reference;
  return asked_for_each_frame ? without_division(graph) : graph;
}

void Stack::State::cut(Graph& built) {
  images.assign(1, built.images[built.source].name);
  for (const auto& pass : built.passes) images.push_back(built.images[pass.output].name);
  if (scripts.shown.empty()) {
    shows = true;
    return;
  }
  const auto found = std::ranges::find(images, scripts.shown);
  shows = found != images.end();
  if (!shows) {
    scripts.diagnostics->warn_once(
        "show " + scripts.shown,
        fmt::format("the graph has no image '{}': the result is shown in its place", scripts.shown));
    return;
  }
  built.result = found == images.begin() ? built.source : built.passes[found - images.begin() - 1].output;
  separate_result(built);
}

Result<Graph> Stack::State::build(const BuildContext& context, const std::optional<DisplayEncoding>& encoding) {
  const auto start = Clock::now();
  AFTERGLOW_TRY(Graph built, scripts.preset->build(context, *scripts.diagnostics));
  cut(built);
  AFTERGLOW_CHECK(validate(built));
  if (encoding && !options.reference && built.result != built.source) encode_for_display(built, *encoding);
  script_ms += milliseconds_since(start);
  return built;
}

Result<Hash> Stack::State::texts_of(const Graph& built) {
  Hasher hasher;
  for (const auto& pass : built.passes) {
    if (pass.shader.empty()) continue;
    AFTERGLOW_TRY(const auto source, scripts.shaders->find(pass.shader));
    hasher.add(source->hash.high).add(source->hash.low);
  }
  return hasher.finish();
}

Result<Stack::State::Next> Stack::State::look_ahead(const BuildContext& context,
                                                    const std::optional<DisplayEncoding>& encoding,
                                                    const std::optional<Rect>& wanted_region) {
  Next next{.spare = spares.end()};
  AFTERGLOW_TRY(next.graph, build(context, encoding));
  next.region = wanted_region;
  next.encoded = encoding && !options.reference && next.graph.result != next.graph.source;
  const auto fits = [&](const Graph& made_for, const std::optional<Rect>& made_region) {
    return made_region == wanted_region && (!wanted_region || same_reach(made_for, next.graph)) &&
           same_structure(made_for, next.graph);
  };
  next.present = prepared && fits(graph, region);
  if ((options.shared || options.spare_programs > 0) && (adopted || !next.present)) {
    AFTERGLOW_TRY(next.texts, texts_of(next.graph));
    next.present = next.present && texts == next.texts;
  }
  if (!next.present && next.texts)
    next.spare = std::ranges::find_if(spares, [&](const Spare& spare) {
      return spare.texts == *next.texts && spare.encoded == next.encoded && fits(spare.graph, spare.region);
    });
  return next;
}

void Stack::State::put_aside() {
  if (options.spare_programs > 0 && prepared && program && texts)
    spares.insert(spares.begin(), {std::move(graph), *texts, region, encoded, std::exchange(program, nullptr),
                                   std::exchange(idle, {})});
}

void Stack::State::drop_spares() {
  std::uint64_t bytes = program ? program->memory().arena : 0;
  std::size_t stay = 0;
  while (stay < spares.size() && stay < static_cast<std::size_t>(options.spare_programs)) {
    bytes += spares[stay].program->memory().arena;
    if (bytes > options.max_memory) break;
    ++stay;
  }
  spares.erase(spares.begin() + static_cast<std::ptrdiff_t>(stay), spares.end());
}

Result<void> Stack::State::take(Next next, const BuildContext& context) {
  std::optional<Spare> found;
  if (next.spare != spares.end()) {
    found = std::move(*next.spare);
    spares.erase(next.spare);
  }
  if (!next.present) put_aside();
  if (next.texts) texts = next.texts, adopted = false;
  region = next.region;
  encoded = next.encoded;
  graph = std::move(next.graph);
  prepared = true;
  if (found) {
    program = std::move(found->program);
    idle = std::move(found->idle);
    AFTERGLOW_CHECK(fit_histories());
    AFTERGLOW_CHECK(program->use(histories));
    AFTERGLOW_CHECK(idle.use(histories));
  } else if (!next.present) {
    AFTERGLOW_CHECK(make());
  }
  if (found || next.present) {
    if (program) program->set_parameters(graph_of_program());
    idle.set_parameters(graph);
  }
  drop_spares();
  if (graph.result != graph.source)
    histories->begin(context.frame, context.step, context.restart);
  else
    histories->reset();
  return {};
}

Result<void> Stack::State::make() {
  // Images that programs share go with the last of them: where they are kept, the program before stays until the new
  // one is there.
  std::unique_ptr<Program> before = std::exchange(program, nullptr);
  idle = {};
  if (!options.keep_images) before.reset();
  if (graph.result == graph.source) return {};
  const auto start = Clock::now();
  AFTERGLOW_CHECK(fit_histories());
  auto made = Program::create(*device, *scripts.shaders, shared->compiler, graph_of_program(), options_of_programs());
  prepared = made.ok();
  if (!made) return std::move(made).error();
  program = std::move(made).value();
  device->save_pipeline_cache();
  compile_ms += milliseconds_since(start);
  return {};
}

}  // namespace afterglow
