#include "session/stack.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "core/stopwatch.h"
#include "graph/history.h"
#include "graph/plan.h"
#include "graph/region.h"
#include "session/stack_state.h"
#include "shader/kernel.h"

namespace afterglow {
namespace {

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
  return on.draw(*state_->scripts.shaders, state_->shared->compiler, state_->graph_of_program(),
                 state_->options_of_programs());
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
  return state_->program && options.skip_idle && !options.reference &&
         (!state_->graph.idle.empty() || straight_passes(state_->graph) > 0);
}

Result<IdlePrograms::Choice> Stack::program_for(const SourceContent& content) {
  const auto start = Clock::now();
  const int before = state_->idle.size();
  ProgramOptions options = state_->options_of_programs();
  options.max_memory -= std::min(options.max_memory, state_->program->memory().arena);
  auto choice = state_->idle.choose(*state_->device, *state_->scripts.shaders, state_->shared->compiler,
                                    *state_->program, state_->graph, options, content);
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
