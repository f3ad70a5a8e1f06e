#include "session/stack.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

#include "exec/histories.h"
#include "graph/history.h"
#include "graph/plan.h"
#include "graph/region.h"
#include "session/calibration.h"
#include "shader/kernel.h"

namespace afterglow {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

constexpr Choice kReference{.joining = Joining::none, .share_memory = false};

StackChoice choose(const Device& device, const StackOptions& options, const Calibration& calibration,
                   double max_error) {
  if (options.reference) return {kReference, "--reference", max_error};
  if (options.choice) return {*options.choice, "given", max_error};
  StackChoice choice{{}, {}, max_error};
  const Calibration::Found found = calibration.find(device.info(), max_error);
  choice.execution = found.choice;
  choice.execution.rows = std::min(choice.execution.rows, options.most_rows);
  choice.from = found.from;
  if (options.precision == Precision::automatic) return choice;
  choice.execution.storage = options.precision == Precision::fp16 ? Storage::fp16 : Storage::fp32;
  choice.from += "; --precision";
  return choice;
}

}  // namespace

struct Stack::State {
  StackOptions options;
  std::shared_ptr<StackShared> shared;
  /// What comes from scripts; `adopt` replaces it whole.
  struct Scripts {
    Diagnostics* diagnostics = nullptr;
    std::unique_ptr<ShaderLibrary> shaders;
    std::optional<Preset> preset;
    std::string shown;
  } scripts;
  std::vector<std::string> images;  ///< of the last graph
  bool shows = true;
  Device* device = nullptr;
  Calibration calibration;
  StackChoice choice;
  bool own_images = false;
  Graph graph;
  std::optional<Hash> texts;   ///< of the shaders of `graph`, once they have been asked for
  bool adopted = false;        ///< the texts may not be those that `program` was made of
  std::optional<Rect> region;  ///< that `program` was made for
  bool encoded = false;        ///< its result holds display codes
  bool prepared = false;
  std::shared_ptr<Histories> histories = std::make_shared<Histories>();
  std::unique_ptr<Program> program;
  IdlePrograms idle;
  /// Of other structures, the one used last first.
  struct Spare {
    Graph graph;
    Hash texts;
    std::optional<Rect> region;
    bool encoded = false;
    std::unique_ptr<Program> program;
    IdlePrograms idle;
  };
  std::vector<Spare> spares;
  double script_ms = 0, compile_ms = 0;

  /// Before the programs are made: what earlier frames handed on stays where it still means the same.
  Result<void> fit_histories() {
    const bool half = choice.execution.storage == Storage::fp16 && !options.reference;
    return histories->fit(*device, graph,
                          {.half = half, .storage = choice.execution.storage_reads, .max_memory = options.max_memory});
  }

  ProgramOptions options_of_programs() const {
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

  Result<Graph> build(const BuildContext& context, const std::optional<DisplayEncoding>& encoding);
  Result<void> make();
  /// What `prepare` would do.
  struct Next {
    Graph graph;
    std::optional<Rect> region;
    bool encoded = false;
    bool present = false;       ///< the present program will do
    std::optional<Hash> texts;  ///< where they were looked at
    std::vector<Spare>::iterator spare;
  };
  Result<Next> look_ahead(const BuildContext& context, const std::optional<DisplayEncoding>& encoding,
                          const std::optional<Rect>& region);
  Result<void> take(Next next, const BuildContext& context);
  void put_aside();
  void drop_spares();
  void cut(Graph& built);
  Result<Hash> texts_of(const Graph& built);
};

Stack::Stack(std::unique_ptr<State> state) : state_(std::move(state)) {}
Stack::~Stack() = default;

Result<std::unique_ptr<Stack>> Stack::load(const std::filesystem::path& preset, const StackOptions& options,
                                           Diagnostics& diagnostics) {
  const auto start = Clock::now();
  auto state = std::make_unique<State>();
  state->options = options;
  state->scripts.diagnostics = &diagnostics;
  state->scripts.shaders = std::make_unique<ShaderLibrary>(search_path_for(preset, options.preset.paths));
  const auto& cache = options.cache_folder;
  state->shared = options.shared;
  if (!state->shared) state->shared = std::make_shared<StackShared>(cache.empty() ? cache : cache / "shaders");
  AFTERGLOW_TRY(Preset loaded, Preset::load(preset, options.preset, *state->scripts.shaders, diagnostics));
  state->scripts.preset.emplace(std::move(loaded));
  AFTERGLOW_TRY(state->calibration,
                options.calibration.empty() ? Calibration::shipped() : Calibration::load(options.calibration));
  state->choice.max_error =
      options.max_error.value_or(state->scripts.preset->max_error().value_or(state->choice.max_error));
  state->script_ms = milliseconds_since(start);
  return std::unique_ptr<Stack>(new Stack(std::move(state)));
}

Preset& Stack::preset() { return *state_->scripts.preset; }
bool Stack::runs() const { return state_->prepared && state_->graph.result != state_->graph.source; }
Program* Stack::program() { return state_->program.get(); }
const Graph& Stack::prepared_graph() const { return state_->graph; }
const StackChoice& Stack::choice() const { return state_->choice; }

std::vector<Skipped> Stack::skipped() const {
  std::vector<Skipped> all = state_->graph.skipped;
  if (const Program* program = state_->program.get()) {
    all.insert(all.end(), program->plan().skipped.begin(), program->plan().skipped.end());
    if (state_->region) all.push_back(skipped_pixels(program->graph(), program->plan(), program->parts()));
  }
  return all;
}

double Stack::script_milliseconds() const { return state_->script_ms; }
double Stack::compile_milliseconds() const { return state_->compile_ms; }

VkFormat Stack::result_format() const {
  if (state_->program) return state_->program->result_format();
  return state_->choice.execution.storage == Storage::fp16 ? VK_FORMAT_R16G16B16A16_SFLOAT
                                                           : VK_FORMAT_R32G32B32A32_SFLOAT;
}

Result<Graph> Stack::graph(const BuildContext& context) { return state_->build(context, {}); }

void Stack::show(const std::string& image) { state_->scripts.shown = image; }
bool Stack::shows() const { return state_->shows; }
const std::vector<std::string>& Stack::images() const { return state_->images; }

/// Ends the graph at the image that is shown. Passes behind it are dropped as nobody reads them.
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

/// Of all shaders of the graph, with what they include.
Result<Hash> Stack::State::texts_of(const Graph& built) {
  Hasher hasher;
  for (const auto& pass : built.passes) {
    if (pass.shader.empty()) continue;
    AFTERGLOW_TRY(const auto source, scripts.shaders->find(pass.shader));
    hasher.add(source->hash.high).add(source->hash.low);
  }
  return hasher.finish();
}

Result<StackWork> Stack::build(const BuildContext& context, const std::optional<DisplayEncoding>& encoding) {
  AFTERGLOW_TRY(state_->graph, state_->build(context, encoding));
  AFTERGLOW_TRY(state_->texts, state_->texts_of(state_->graph));
  state_->prepared = false;
  return StackWork{state_->graph, *state_->texts, state_->choice};
}

bool same_work(const StackWork& a, const StackWork& b) {
  return a.texts == b.texts && a.choice.execution == b.choice.execution && a.choice.max_error == b.choice.max_error &&
         same_structure(a.graph, b.graph);
}

Result<void> Stack::prepare_built(const std::optional<DisplayEncoding>& encoding) {
  state_->prepared = true;
  state_->region.reset();
  state_->encoded = encoding && !state_->options.reference && runs();
  return state_->make();
}

void Stack::adopt(Stack& later) {
  std::swap(state_->scripts, later.state_->scripts);
  std::swap(state_->options.preset, later.state_->options.preset);
  state_->adopted = true;
}

Result<std::uint64_t> Stack::memory_needed(const BuildContext& context) {
  AFTERGLOW_TRY(const Graph graph, this->graph(context));
  const bool reference = state_->options.reference;
  const std::uint64_t bytes_per_pixel = state_->options.precision == Precision::fp16 && !reference ? 8 : 16;
  const Plan plan = make_plan(graph, {.joining = reference ? Joining::none : Joining::all});
  std::vector<Block> blocks;
  std::uint64_t kept = 0;
  for (std::size_t i = 0; i < plan.transient.size(); ++i) {
    const auto pixels = static_cast<std::uint64_t>(graph.images[plan.transient[i]].size.area());
    // Both images of a history have memory of their own; one of them counts among the inputs below.
    if (history_of_next(graph, plan.transient[i])) {
      kept += pixels * (is_precise(graph, plan.transient[i]) ? 32 - bytes_per_pixel : bytes_per_pixel);
      continue;
    }
    blocks.push_back({pixels * bytes_per_pixel, 1, plan.lifetimes[i].first, plan.lifetimes[i].last});
  }
  std::uint64_t total = kept + place(blocks, !reference && !state_->options.keep_images).total;
  for (const auto& image : graph.images)
    if (image.producer < 0) total += static_cast<std::uint64_t>(image.size.area()) * bytes_per_pixel;
  return total;
}

void Stack::use(Device& device, bool own_images) {
  state_->device = &device;
  state_->own_images = own_images;
  state_->choice = choose(device, state_->options, state_->calibration, state_->choice.max_error);
  if (const auto& cache = state_->options.cache_folder; !cache.empty() && !state_->options.shared)
    device.use_pipeline_cache((cache / "pipelines").string());
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

/// The present program becomes a spare one, if it may be wanted again.
void Stack::State::put_aside() {
  if (options.spare_programs > 0 && prepared && program && texts)
    spares.insert(spares.begin(), {std::move(graph), *texts, region, encoded, std::exchange(program, nullptr),
                                   std::exchange(idle, {})});
}

/// As many as may stay, within the memory that the stack may have.
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
    if (program) program->set_parameters(graph);
    idle.set_parameters(graph);
  }
  drop_spares();
  if (graph.result != graph.source)
    histories->begin(context.frame, context.step, context.restart);
  else
    histories->reset();
  return {};
}

Result<void> Stack::prepare(const BuildContext& context, const std::optional<DisplayEncoding>& encoding,
                            const std::optional<Rect>& region) {
  AFTERGLOW_TRY(auto next, state_->look_ahead(context, encoding, region));
  return state_->take(std::move(next), context);
}

Result<bool> Stack::prepare_if_made(const BuildContext& context) {
  AFTERGLOW_TRY(auto next, state_->look_ahead(context, {}, {}));
  const bool made =
      next.present || next.spare != state_->spares.end() || next.graph.result == next.graph.source || !state_->prepared;
  if (made) AFTERGLOW_CHECK(state_->take(std::move(next), context));
  return made;
}

void Stack::keep_programs_of(Stack& other) {
  State &s = *state_, &from = *other.state_;
  from.put_aside();
  std::ranges::move(from.spares, std::back_inserter(s.spares));
  from.spares.clear();
  s.drop_spares();
}

Result<void> Stack::warm_up(WarmUp& on) {
  if (!runs()) return {};
  return on.draw(*state_->scripts.shaders, state_->shared->compiler, state_->graph, state_->options_of_programs());
}

/// The program of `graph`.
Result<void> Stack::State::make() {
  // Images that programs share go with the last of them: where they are kept, the program before stays until the new
  // one is there.
  std::unique_ptr<Program> before = std::exchange(program, nullptr);
  idle = {};
  if (!options.keep_images) before.reset();
  if (graph.result == graph.source) return {};
  const auto start = Clock::now();
  AFTERGLOW_CHECK(fit_histories());
  auto made = Program::create(*device, *scripts.shaders, shared->compiler, graph, options_of_programs());
  prepared = made.ok();
  if (!made) return std::move(made).error();
  program = std::move(made).value();
  device->save_pipeline_cache();
  compile_ms += milliseconds_since(start);
  return {};
}

Result<std::unique_ptr<Program>> Stack::program_by_passes(const Graph& graph, const std::optional<Rect>& region) const {
  ProgramOptions options = program_options(kReference);
  const bool halves = std::ranges::any_of(graph.histories, [](const History& history) { return !history.precise; });
  if (halves) options.storage = state_->choice.execution.storage;
  options.reference = true;
  options.storage_reads = state_->choice.execution.storage_reads;  // as the histories are made
  options.region = region;
  options.max_memory = state_->options.max_memory;
  options.pipelines = &state_->shared->pipelines;
  options.histories = state_->histories;
  return Program::create(*state_->device, *state_->scripts.shaders, state_->shared->compiler, graph, options);
}

std::filesystem::path Stack::shader_file(const std::string& shader) const {
  if (shader.empty()) return {};
  const auto found = state_->scripts.shaders->find(shader);
  return found ? (*found)->path : std::filesystem::path();
}

bool Stack::depends_on_content() const {
  const StackOptions& options = state_->options;
  return state_->program && options.skip_idle && !options.reference && !state_->graph.idle.empty();
}

Result<IdlePrograms::Choice> Stack::program_for(float brightest) {
  const auto start = Clock::now();
  const int before = state_->idle.size();
  ProgramOptions options = state_->options_of_programs();
  options.max_memory -= std::min(options.max_memory, state_->program->memory().arena);
  auto choice = state_->idle.choose(*state_->device, *state_->scripts.shaders, state_->shared->compiler,
                                    *state_->program, state_->graph, options, brightest);
  if (state_->idle.size() > before) {
    state_->device->save_pipeline_cache();
    state_->compile_ms += milliseconds_since(start);
  }
  return choice;
}

const std::optional<Rect>& Stack::region() const { return state_->region; }
int Stack::programs() const { return (state_->program ? 1 : 0) + state_->idle.size(); }

Result<void> Stack::bind(const std::map<std::string, ImageBinding>& inputs, const ImageBinding& result) {
  if (!state_->program) return {};
  return state_->program->bind(inputs, result);
}

void Stack::record(VkCommandBuffer commands) {
  if (!state_->program) return;
  state_->program->record(commands);
  state_->histories->made();
}

void Stack::reset_histories() { state_->histories->reset(); }

Result<void> Stack::take_histories(Stack& other) {
  if (!state_->program) return {};
  state_->histories->take(*other.state_->histories);
  AFTERGLOW_CHECK(state_->program->use(state_->histories));
  return state_->idle.use(state_->histories);
}

}  // namespace afterglow
