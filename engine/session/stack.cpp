#include "session/stack.h"

#include <algorithm>
#include <chrono>

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
  choice.from = found.from;
  if (options.precision == Precision::automatic) return choice;
  choice.execution.storage = options.precision == Precision::fp16 ? Storage::fp16 : Storage::fp32;
  choice.from += "; --precision";
  return choice;
}

}  // namespace

struct Stack::State {
  StackOptions options;
  Diagnostics* diagnostics = nullptr;
  std::unique_ptr<ShaderLibrary> shaders;
  std::unique_ptr<KernelCompiler> compiler;
  std::optional<Preset> preset;
  Device* device = nullptr;
  Calibration calibration;
  StackChoice choice;
  bool own_images = false;
  Graph graph;
  std::optional<Rect> region;  ///< that `program` was made for
  bool encoded = false;        ///< its result holds display codes
  bool prepared = false;
  std::shared_ptr<Histories> histories = std::make_shared<Histories>();
  std::unique_ptr<Program> program;
  IdlePrograms idle;
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
    out.keep_images = options.keep_images;
    out.max_memory = options.max_memory;
    out.histories = histories;
    return out;
  }
};

Stack::Stack(std::unique_ptr<State> state) : state_(std::move(state)) {}
Stack::~Stack() = default;

Result<std::unique_ptr<Stack>> Stack::load(const std::filesystem::path& preset, const StackOptions& options,
                                           Diagnostics& diagnostics) {
  const auto start = Clock::now();
  auto state = std::make_unique<State>();
  state->options = options;
  state->diagnostics = &diagnostics;
  state->shaders = std::make_unique<ShaderLibrary>(search_path_for(preset, options.preset.paths));
  const auto& cache = options.cache_folder;
  state->compiler = std::make_unique<KernelCompiler>(cache.empty() ? cache : cache / "shaders");
  AFTERGLOW_TRY(Preset loaded, Preset::load(preset, options.preset, *state->shaders, diagnostics));
  state->preset.emplace(std::move(loaded));
  AFTERGLOW_TRY(state->calibration,
                options.calibration.empty() ? Calibration::shipped() : Calibration::load(options.calibration));
  state->choice.max_error = options.max_error.value_or(state->preset->max_error().value_or(state->choice.max_error));
  state->script_ms = milliseconds_since(start);
  return std::unique_ptr<Stack>(new Stack(std::move(state)));
}

Preset& Stack::preset() { return *state_->preset; }
bool Stack::runs() const { return state_->prepared && state_->graph.result != state_->graph.source; }
Program* Stack::program() { return state_->program.get(); }
const Graph& Stack::prepared_graph() const { return state_->graph; }
const StackChoice& Stack::choice() const { return state_->choice; }
double Stack::script_milliseconds() const { return state_->script_ms; }
double Stack::compile_milliseconds() const { return state_->compile_ms; }

VkFormat Stack::result_format() const {
  if (state_->program) return state_->program->result_format();
  return state_->choice.execution.storage == Storage::fp16 ? VK_FORMAT_R16G16B16A16_SFLOAT
                                                           : VK_FORMAT_R32G32B32A32_SFLOAT;
}

Result<Graph> Stack::graph(const BuildContext& context) {
  const auto start = Clock::now();
  AFTERGLOW_TRY(Graph graph, state_->preset->build(context, *state_->diagnostics));
  AFTERGLOW_CHECK(validate(graph));
  state_->script_ms += milliseconds_since(start);
  return graph;
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
  if (const auto& cache = state_->options.cache_folder; !cache.empty())
    device.use_pipeline_cache((cache / "pipelines").string());
}

Result<void> Stack::prepare(const BuildContext& context, const std::optional<DisplayEncoding>& encoding,
                            const std::optional<Rect>& region) {
  AFTERGLOW_TRY(Graph graph, this->graph(context));
  const bool encoded = encoding && !state_->options.reference && graph.result != graph.source;
  if (encoded) encode_for_display(graph, *encoding);
  const bool same_region = state_->region == region && (!region || same_reach(state_->graph, graph));
  const bool reusable = state_->prepared && same_region && same_structure(state_->graph, graph);
  state_->region = region;
  state_->encoded = encoded;
  state_->graph = std::move(graph);
  state_->prepared = true;
  if (reusable) {
    if (state_->program) state_->program->set_parameters(state_->graph);
    state_->idle.set_parameters(state_->graph);
    state_->histories->begin(context.frame, context.step, context.restart);
    return {};
  }
  state_->program.reset();
  state_->idle = {};
  if (!runs()) {
    state_->histories->reset();
    return {};
  }
  const auto start = Clock::now();
  const ProgramOptions options = state_->options_of_programs();
  AFTERGLOW_CHECK(state_->fit_histories());
  state_->histories->begin(context.frame, context.step, context.restart);
  auto program = Program::create(*state_->device, *state_->shaders, *state_->compiler, state_->graph, options);
  if (!program) {
    state_->prepared = false;
    return std::move(program).error();
  }
  state_->program = std::move(program).value();
  state_->device->save_pipeline_cache();
  state_->compile_ms += milliseconds_since(start);
  return {};
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
  auto choice = state_->idle.choose(*state_->device, *state_->shaders, *state_->compiler, *state_->program,
                                    state_->graph, options, brightest);
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
