// SPDX-License-Identifier: MIT
#include "session/stack.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/stopwatch.h"
#include "exec/calibration.h"
#include "graph/history.h"
#include "graph/memory.h"
#include "graph/region.h"
#include "session/half_floats.h"

namespace afterglow {
namespace {

constexpr ExecutionConfig kReference{.fusion = Fusion::none, .share_memory = false};

StackChoice choose_way(const Device& device, const StackOptions& options, const Calibration& calibration,
                       double max_error) {
  if (options.reference) return {kReference, "--reference", max_error};
  if (options.choice) return {*options.choice, "given", max_error};
  StackChoice choice{{}, {}, max_error};
  const Calibration::Found found = calibration.find(device.info(), max_error);
  choice.execution = found.choice;
  choice.execution.rows = std::min(choice.execution.rows, options.most_rows);
  choice.from = found.from;
  if (options.precision != Precision::automatic) {
    choice.execution.storage = options.precision == Precision::fp16 ? Storage::fp16 : Storage::fp32;
    choice.from += "; --precision";
  }
  if (const std::string& words = device.forced().execution; !words.empty()) {
    if (const auto forced = parse_execution(words, choice.execution)) choice.execution = *forced;
    choice.from += "; forced";
  }
  return choice;
}

/// What the device cannot do is told where the way is.
StackChoice choose(const Device& device, const StackOptions& options, const Calibration& calibration,
                   double max_error) {
  StackChoice choice = choose_way(device, options, calibration, max_error);
  if (device.info().few_channels || choice.execution.four_channels) return choice;
  choice.execution.four_channels = true;
  choice.from += "; the device has no images of one and two channels";
  return choice;
}

/// Whether AFTERGLOW_FORCE says what images hold.
bool forces_storage(const Device& device) {
  const auto with = [&](Storage storage) { return parse_execution(device.forced().execution, {.storage = storage}); };
  const auto half = with(Storage::fp16), full = with(Storage::fp32);
  return half && full && half->storage == full->storage;
}

}  // namespace

struct Stack::State {
  StackOptions options;
  std::shared_ptr<SharedKernels> shared;
  Diagnostics* diagnostics = nullptr;
  std::unique_ptr<ShaderLibrary> shaders;
  std::optional<Preset> preset;
  std::string shown;
  std::vector<std::string> images;  ///< of the last graph
  bool shows = true;
  Calibration calibration;
  StackChoice choice;                      ///< by the device
  StackChoice chosen;                      ///< by what the last frame's effects promise, too
  bool may_be_full = false;                ///< half floats are the device's choice alone
  std::shared_ptr<const Build> build;      ///< that was prepared last
  std::unique_ptr<ProgramCache> programs;  ///< null without a device
  double script_ms = 0;

  void cut(Graph& graph);
  void choose_storage(const Build& frame);
};

Stack::Stack(std::unique_ptr<State> state) : state_(std::move(state)) {}
Stack::~Stack() = default;

Result<std::unique_ptr<Stack>> Stack::load(const std::filesystem::path& preset, const StackOptions& options,
                                           Diagnostics& diagnostics) {
  const auto start = Clock::now();
  auto state = std::make_unique<State>();
  state->options = options;
  state->diagnostics = &diagnostics;
  state->shaders = std::make_unique<ShaderLibrary>(
      search_path_for(preset, options.preset.paths, options.preset.record, options.preset.installation));
  const auto& cache = options.cache_folder;
  state->shared = options.shared;
  if (!state->shared) state->shared = std::make_shared<SharedKernels>(cache.empty() ? cache : cache / "shaders");
  AFTERGLOW_TRY(Preset loaded, Preset::load(preset, options.preset, *state->shaders, diagnostics));
  state->preset.emplace(std::move(loaded));
  AFTERGLOW_TRY(state->calibration, options.calibration.empty() ? Calibration::shipped(options.preset.installation)
                                                                : Calibration::load(options.calibration));
  state->choice.max_error = options.max_error.value_or(state->preset->max_error().value_or(state->choice.max_error));
  state->script_ms = milliseconds_since(start);
  return std::unique_ptr<Stack>(new Stack(std::move(state)));
}

Preset& Stack::preset() { return *state_->preset; }
ShaderLibrary& Stack::shaders() { return *state_->shaders; }
ProgramCache* Stack::programs() { return state_->programs.get(); }
Program* Stack::program() const { return state_->programs ? state_->programs->program() : nullptr; }
const std::shared_ptr<const Build>& Stack::build() const { return state_->build; }
const StackChoice& Stack::choice() const { return state_->chosen; }
void Stack::show(const std::string& image) { state_->shown = image; }
bool Stack::shows() const { return state_->shows; }
const std::vector<std::string>& Stack::images() const { return state_->images; }
double Stack::script_milliseconds() const { return state_->script_ms; }
double Stack::compile_milliseconds() const { return state_->programs ? state_->programs->milliseconds() : 0; }

bool Stack::runs() const {
  const FrameWork* work = state_->programs ? state_->programs->work() : nullptr;
  return work && work->runs();
}

std::vector<Skipped> Stack::skipped() const {
  const FrameWork* work = state_->programs ? state_->programs->work() : nullptr;
  if (!work) return {};
  std::vector<Skipped> all = work->graph.skipped;
  if (const Program* program = this->program()) {
    all.insert(all.end(), program->plan().skipped.begin(), program->plan().skipped.end());
    if (work->region) all.push_back(skipped_pixels(program->graph(), program->plan(), program->parts()));
  }
  return all;
}

VkFormat Stack::result_format() const {
  if (const Program* program = this->program()) return program->result_format();
  return state_->chosen.execution.storage == Storage::fp16 ? VK_FORMAT_R16G16B16A16_SFLOAT
                                                           : VK_FORMAT_R32G32B32A32_SFLOAT;
}

Result<std::shared_ptr<const Build>> Stack::evaluate(const BuildContext& context) {
  const auto start = Clock::now();
  AFTERGLOW_TRY(Build build, state_->preset->evaluate(context, *state_->diagnostics));
  state_->script_ms += milliseconds_since(start);
  return std::make_shared<const Build>(std::move(build));
}

/// Ends the graph at the image that is shown. Passes behind it are dropped as nobody reads them.
void Stack::State::cut(Graph& graph) {
  images.assign(1, graph.images[graph.source].name);
  for (const auto& pass : graph.passes) images.push_back(graph.images[pass.output].name);
  const auto found = shown.empty() ? images.end() : std::ranges::find(images, shown);
  shows = shown.empty() || found != images.end();
  if (!shows)
    diagnostics->warn_once("show " + shown,
                           fmt::format("the graph has no image '{}': the result is shown in its place", shown));
  if (found == images.end()) return;
  graph.result = found == images.begin() ? graph.source : graph.passes[found - images.begin() - 1].output;
  separate_result(graph);
}

/// Half floats where every effect of the frame promises what is allowed. Where they are asked for, they are taken, and
/// what they may cost is told.
void Stack::State::choose_storage(const Build& frame) {
  chosen = choice;
  if (choice.execution.storage != Storage::fp16 || options.choice) return;
  const HalfFloatPromise promise = half_float_promise(frame);
  if (promise.error <= choice.max_error) return;
  if (may_be_full) {
    chosen.execution.storage = Storage::fp32;
    chosen.from += fmt::format("; full floats, as in half floats {}", promise.reason);
  } else if (options.precision == Precision::fp16) {
    diagnostics->warn_once("half floats",
                           fmt::format("precision fp16 may miss the error of {:g} that is allowed (--max-error): "
                                       "in half floats {}",
                                       choice.max_error, promise.reason));
  }
}

Result<FrameWork> Stack::work(const FrameRequest& frame) {
  state_->choose_storage(*frame.build);
  FrameWork work{.graph = frame.build->graph,
                 .texts = {},
                 .region = frame.region,
                 .unorm8 = false,
                 .storage = state_->chosen.execution.storage,
                 .frame = frame.build->context.frame,
                 .step = frame.step,
                 .restart = frame.restart};
  state_->cut(work.graph);
  if (state_->options.copy_result && work.runs())
    copy_result(work.graph, work.graph.passes[work.graph.images[work.graph.result].producer].effect);
  AFTERGLOW_CHECK(validate(work.graph));
  // Where nothing else runs, whoever has pictures encodes them; who records has nothing but what is recorded.
  const bool records = state_->programs && !state_->programs->options().own_images;
  work.unorm8 = frame.encoding && !state_->options.reference && (work.runs() || records);
  if (work.unorm8) encode_for_display(work.graph, *frame.encoding);
  AFTERGLOW_TRY(work.texts, texts_of(work.graph, *state_->shaders));
  return work;
}

Result<RenderRequest> Stack::request(FrameRequest frame) {
  RenderRequest request{.programs = state_->programs.get(), .shaders = state_->shaders.get()};
  AFTERGLOW_TRY(request.work, work(frame));
  state_->build = std::move(frame.build);
  return request;
}

std::uint64_t Stack::memory_needed(const Build& build) const {
  const StackOptions& options = state_->options;
  ExecutionConfig config = options.reference ? kReference : ExecutionConfig{};
  if (options.precision == Precision::fp16 && !options.reference) config.storage = Storage::fp16;
  if (options.keep_images) config.share_memory = false;
  return afterglow::memory_needed(build.graph, config);
}

void Stack::use(Device& device, bool own_images) {
  const StackOptions& options = state_->options;
  state_->choice = choose(device, options, state_->calibration, state_->choice.max_error);
  state_->chosen = state_->choice;
  state_->may_be_full = options.precision == Precision::automatic && !forces_storage(device);
  if (const auto& cache = options.cache_folder; !cache.empty() && !options.shared)
    device.use_pipeline_cache((cache / "pipelines").string());
  state_->programs = std::make_unique<ProgramCache>(device, state_->shared,
                                                    ProgramCacheOptions{.config = state_->choice.execution,
                                                                        .reference = options.reference,
                                                                        .own_images = own_images,
                                                                        .skip_idle = options.skip_idle,
                                                                        .flag_non_finite = options.flag_non_finite,
                                                                        .keep_images = options.keep_images,
                                                                        .spare = options.spare_programs,
                                                                        .max_memory = options.max_memory,
                                                                        .diagnostics = state_->diagnostics});
}

Result<void> Stack::prepare(FrameRequest frame) {
  AFTERGLOW_TRY(FrameWork work, this->work(frame));
  state_->build = std::move(frame.build);
  return state_->programs->prepare(std::move(work), *state_->shaders);
}

Result<void> Stack::prepare(const BuildContext& context, const std::optional<DisplayEncoding>& encoding,
                            const std::optional<Rect>& region) {
  AFTERGLOW_TRY(auto build, evaluate(context));
  return prepare(request_for(std::move(build), encoding, region));
}

void Stack::take_over(Stack& before, bool programs) {
  if (!state_->programs || !before.state_->programs) return;
  // The device's choice: what the effects of a frame make of it is asked for each frame.
  const bool alike = state_->choice.execution == before.state_->choice.execution;
  state_->programs->take_over(*before.state_->programs, programs && alike);
}

void Stack::reset_histories() {
  if (state_->programs) state_->programs->reset_histories();
}

std::filesystem::path Stack::shader_file(const std::string& shader) const {
  if (shader.empty()) return {};
  const auto found = state_->shaders->find(shader);
  return found ? (*found)->path : std::filesystem::path();
}

Result<void> Stack::bind(const std::map<std::string, ImageBinding>& inputs, const ImageBinding& result) {
  Program* program = this->program();
  return program ? program->bind(inputs, result) : Result<void>();
}

void Stack::record(VkCommandBuffer commands) {
  const Program* program = this->program();
  if (!program) return;
  program->record(commands);
  state_->programs->made();
}

}  // namespace afterglow
