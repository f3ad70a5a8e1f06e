#include "session/stack.h"

#include <chrono>

#include "graph/plan.h"
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

/// A pixel pass behind the result, which joins the last kernel like any other.
void encode_for_display(Graph& graph, const DisplayEncoding& encoding) {
  const auto output = static_cast<ImageId>(graph.images.size());
  Pass pass;
  pass.name = "output.display";
  pass.effect = "output";
  pass.shader = encoding.straight_alpha ? "output/display_straight" : "output/display";
  pass.inputs = {{"source", graph.result}};
  if (encoding.straight_alpha) pass.inputs.push_back({"original", graph.source, true});
  pass.constants = {{"dither", encoding.dither ? 1.0 : 0.0}};
  pass.output = output;
  graph.images.push_back({pass.name, graph.images[graph.result].size, static_cast<int>(graph.passes.size())});
  graph.passes.push_back(std::move(pass));
  graph.result = output;
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
  bool prepared = false;
  std::unique_ptr<Program> program;
  double script_ms = 0, compile_ms = 0;
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
  for (std::size_t i = 0; i < plan.transient.size(); ++i) {
    const auto pixels = static_cast<std::uint64_t>(graph.images[plan.transient[i]].size.area());
    blocks.push_back({pixels * bytes_per_pixel, 1, plan.lifetimes[i].first, plan.lifetimes[i].last});
  }
  std::uint64_t total = place(blocks, !reference).total;
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

Result<void> Stack::prepare(const BuildContext& context, const std::optional<DisplayEncoding>& encoding) {
  AFTERGLOW_TRY(Graph graph, this->graph(context));
  const bool encoded = encoding && !state_->options.reference && graph.result != graph.source;
  if (encoded) encode_for_display(graph, *encoding);
  const bool reusable = state_->prepared && same_structure(state_->graph, graph);
  state_->graph = std::move(graph);
  state_->prepared = true;
  if (reusable) {
    if (state_->program) state_->program->set_parameters(state_->graph);
    return {};
  }
  state_->program.reset();
  if (!runs()) return {};
  const auto start = Clock::now();
  ProgramOptions options = program_options(state_->choice.execution);
  options.reference = state_->options.reference;
  options.source_is_storage = state_->own_images;
  options.result_by_rows = state_->own_images;
  options.codes = encoded;
  options.max_memory = state_->options.max_memory;
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

Result<void> Stack::bind(const std::map<std::string, ImageBinding>& inputs, const ImageBinding& result) {
  if (!state_->program) return {};
  return state_->program->bind(inputs, result);
}

void Stack::record(VkCommandBuffer commands) const {
  if (state_->program) state_->program->record(commands);
}

}  // namespace afterglow
