#include "session/session.h"

#include <future>

#include "core/stopwatch.h"
#include "session/picture_inputs.h"

namespace afterglow {
namespace {

struct OpenedDevice {
  Result<std::unique_ptr<Device>> device;
  double milliseconds = 0;
};

OpenedDevice open_device(const DeviceOptions& options, Diagnostics& diagnostics) {
  const auto start = Clock::now();
  auto device = Device::create(options, diagnostics);
  return {std::move(device), milliseconds_since(start)};
}

/// Whether the codes have no alpha somewhere in `part` where the picture has some.
bool lost_alpha(const Picture& picture, const Rect& part) {
  for (int y = part.y; y < part.y + part.height; ++y)
    for (int x = part.x; x < part.x + part.width; ++x) {
      const std::size_t alpha =
          4 * (static_cast<std::size_t>(y) * picture.color.width + static_cast<std::size_t>(x)) + 3;
      if (picture.codes[alpha] == 0 && picture.color.pixels[alpha] >= 1.0f / 255) return true;
    }
  return false;
}

}  // namespace

struct Session::State {
  SessionOptions options;
  std::string preset_file;
  // Destroyed in reverse: what was made on the device goes before the device.
  std::unique_ptr<Device> device;
  std::unique_ptr<Stack> stack;
  std::unique_ptr<FrameRunner> runner;
  std::unique_ptr<Tracer> tracer;  ///< once a frame was traced
  HostResult result;
  bool flagged = false;  ///< the last frame's result
  SessionTimes times;
  Program* ran = nullptr;  ///< in the last frame; null: nothing
  std::vector<Skipped> skipped_now;
};

Session::Session(std::unique_ptr<State> state) : state_(std::move(state)) {}
Session::~Session() = default;

Stack& Session::stack() { return *state_->stack; }
Device& Session::device() { return *state_->device; }

Result<std::unique_ptr<Session>> Session::open(const std::filesystem::path& preset, const SessionOptions& options,
                                               Diagnostics& diagnostics) {
  auto opening = std::async(std::launch::async, [&] { return open_device(options.device, diagnostics); });
  auto stack = Stack::load(preset, options.stack, diagnostics);
  OpenedDevice opened = opening.get();
  if (!stack) return std::move(stack).error();
  if (!opened.device) return std::move(opened.device).error();

  auto state = std::make_unique<State>();
  state->options = options;
  state->preset_file = preset.string();
  state->device = std::move(opened.device).value();
  state->stack = std::move(stack).value();
  state->stack->use(*state->device, true);
  // Timestamps around deferred draws mean nothing: there, each kernel is timed in a submission of its own.
  if (options.timing == KernelTiming::timestamps && !state->device->timestamps_mean_draws())
    state->options.timing = KernelTiming::submissions;
  state->times.device = opened.milliseconds;
  AFTERGLOW_TRY(state->runner, FrameRunner::create(*state->device, options.stack.max_memory));
  return std::unique_ptr<Session>(new Session(std::move(state)));
}

Result<void> Session::prepare(const BuildContext& context, const std::optional<DisplayEncoding>& encoding,
                              const std::optional<Rect>& region) {
  state_->ran = nullptr;
  AFTERGLOW_CHECK(state_->stack->prepare(context, encoding, region));
  state_->ran = state_->stack->program();
  return {};
}

Result<void> Session::process(Picture& picture, const BuildContext& frame,
                              const std::optional<DisplayEncoding>& encoding, const std::optional<Rect>& region) {
  const BuildContext context = context_of(picture, frame);
  AFTERGLOW_CHECK(prepare(context, encoding, region));
  state_->times.frame = {};
  state_->result.clamped = 0;
  state_->flagged = state_->result.flagged = false;
  state_->skipped_now.clear();
  if (!state_->stack->runs()) return {};

  // The result replaces the source in its own memory. Effects never change alpha: the source's own values stay where
  // they are, exact whatever the storage format.
  HostResult& result = state_->result;
  const auto inputs = picture_inputs(picture, state_->stack->prepared_graph());
  result.pixels = std::move(picture.color.pixels);
  result.keep_alpha = true;
  picture.content.erase("source");
  FrameRunner::Choose choose;
  if (state_->stack->depends_on_content())
    choose = [this](const SourceContent& content) -> Result<Program*> {
      AFTERGLOW_TRY(const IdlePrograms::Choice choice, state_->stack->program_for(content));
      state_->skipped_now = *choice.skipped;
      return state_->ran = choice.program;
    };
  auto times = state_->runner->run(*state_->stack->program(), inputs, result, state_->options.timing, choose);
  picture.color.pixels = std::move(result.pixels);
  picture.codes = std::move(result.codes);
  if (!times) return std::move(times).error();
  state_->times.frame = std::move(times).value();
  state_->flagged = result.flagged;
  if (result.flagged && encoding && encoding->straight_alpha && !picture.codes.empty())
    state_->flagged = lost_alpha(picture, region.value_or(Rect{0, 0, context.size.width, context.size.height}));
  for (auto& kept : kept_of(state_->times.frame)) state_->skipped_now.push_back(std::move(kept));
  return {};
}

Result<Trace> Session::trace(const Picture& picture, const BuildContext& frame,
                             const std::optional<DisplayEncoding>& encoding, const std::optional<Rect>& region,
                             NanPolicy policy) {
  AFTERGLOW_CHECK(state_->stack->prepare(context_of(picture, frame), encoding, region));
  if (!state_->tracer) state_->tracer = std::make_unique<Tracer>(*state_->device, state_->options.stack.max_memory);
  return state_->tracer->run(*state_->stack, picture, frame, region, policy);
}

SessionReport Session::report() const {
  const Stack& stack = *state_->stack;
  SessionReport report;
  report.device = state_->device->info().name;
  report.driver = state_->device->info().driver;
  report.preset = state_->preset_file;
  report.choice = stack.choice();
  report.reference = state_->options.stack.reference;
  report.skipped = stack.skipped();
  report.skipped_now = state_->skipped_now;
  report.counters = {.programs = stack.programs(),
                     .images = state_->runner->counters().images,
                     .buffers = state_->runner->counters().buffers};
  if (state_->ran)
    for (const auto& kernel : state_->ran->plan().kernels) report.kernels.push_back(kernel.name);
  if (const Program* program = state_->stack->program()) report.memory = program->memory();
  report.clamped = state_->result.clamped;
  report.flagged = state_->flagged;
  report.times = state_->times;
  report.times.script = stack.script_milliseconds();
  report.times.compile = stack.compile_milliseconds();
  return report;
}

}  // namespace afterglow
