#include "session/live_session.h"

#include <algorithm>

#include "session/picture_inputs.h"

namespace afterglow {

struct LiveSession::State {
  std::unique_ptr<LiveStack> live;
  std::unique_ptr<FrameRunner> runner;  // first to go: it waits for what is in flight
  std::optional<BuildContext> context;  ///< of the last frame
  FrameTimes times;
  std::vector<Skipped> skipped_now;
  Program* ran = nullptr;
  std::uint64_t ran_in = 0;  ///< LiveStack::stacks_taken when `ran` was of the stack
  bool aside = false, waits = false;
  int misses = 0;  ///< builds in a row that came too late for the frame that they were for
  /// Kernels of a program, timed in turns.
  struct {
    std::uint64_t program = 0;
    std::size_t next = 0;
    bool all = false;
    std::vector<KernelTime> times;  ///< parallel to its kernels; below 0: not known
  } timed;

  /// What ran last, as long as it is there.
  Program* alive() const { return live->stacks_taken() == ran_in ? ran : nullptr; }

  Result<void> prepare(const BuildContext& next);
  Result<bool> prepare_aside(const BuildContext& next);
  FrameRunner::Choose choose();
};

LiveSession::LiveSession(std::unique_ptr<State> state) : state_(std::move(state)) {}
LiveSession::~LiveSession() = default;

Result<std::unique_ptr<LiveSession>> LiveSession::open(Device& device, const std::filesystem::path& preset,
                                                       const LiveOptions& options, Diagnostics& diagnostics) {
  auto state = std::make_unique<State>();
  AFTERGLOW_TRY(state->live, LiveStack::open(device, preset, options, diagnostics));
  AFTERGLOW_TRY(state->runner, FrameRunner::create(device, options.stack.max_memory));
  return std::unique_ptr<LiveSession>(new LiveSession(std::move(state)));
}

LiveStack& LiveSession::live() { return *state_->live; }
DeviceImages LiveSession::images() const { return state_->runner->images(); }
const FrameTimes& LiveSession::times() const { return state_->times; }
FrameRunner::Counters LiveSession::counters() const { return state_->runner->counters(); }
Result<void> LiveSession::read_result(HostResult& out, const std::optional<Rect>& part) {
  return state_->runner->read_result(out, part);
}

namespace {

Result<bool> made(Result<void> prepared) {
  if (!prepared) return std::move(prepared).error();
  return true;
}

}  // namespace

/// The stack as it is now, for this frame.
Result<void> LiveSession::State::prepare(const BuildContext& next) {
  const bool new_shape = !context || context->size != next.size || context->auxiliary != next.auxiliary;
  context = next;
  live->set_context(next);
  if (new_shape) live->settle();
  live->update();
  Stack* stack = live->stack();
  if (!stack) return {};
  const FileTrace trace;
  const auto prepared = aside && !new_shape ? prepare_aside(next) : made(stack->prepare(next));
  live->also_follow(trace.looks());
  if (!prepared) return prepared.error();
  waits = !*prepared;
  return {};
}

/// False while the frame's structure is being built.
Result<bool> LiveSession::State::prepare_aside(const BuildContext& next) {
  constexpr int kMostMisses = 3;  // then the structure moves faster than builds come
  Stack& stack = *live->stack();
  AFTERGLOW_TRY(const bool there, stack.prepare_if_made(next));
  if (there || misses >= kMostMisses) {
    misses = 0;
    return there ? Result<bool>(true) : made(stack.prepare(next));
  }
  if (!live->building()) {
    live->build_for_frame();
    ++misses;
  }
  return false;
}

/// Frames whose content makes effects idle run without them.
FrameRunner::Choose LiveSession::State::choose() {
  if (!live->stack() || !live->stack()->depends_on_content()) return {};
  return [this](const SourceContent& content) -> Result<Program*> {
    AFTERGLOW_TRY(const IdlePrograms::Choice choice, live->stack()->program_for(content));
    skipped_now = *choice.skipped;
    return ran = choice.program;
  };
}

Result<void> LiveSession::process(const Picture& picture, const BuildContext& frame, KernelTiming timing) {
  State& s = *state_;
  s.waits = false;
  const auto prepared = s.prepare(context_of(picture, frame));
  if (prepared && s.waits) return {};
  s.ran = nullptr;
  s.ran_in = s.live->stacks_taken();
  s.skipped_now.clear();
  AFTERGLOW_CHECK(prepared);
  const Stack* stack = s.live->stack();
  s.ran = stack && stack->runs() ? s.live->stack()->program() : nullptr;
  const auto inputs = picture_inputs(picture, s.ran ? s.ran->graph() : Graph{});
  AFTERGLOW_TRY(s.times, s.runner->run_on_device(s.ran, inputs, timing, s.ran ? s.choose() : FrameRunner::Choose{}));
  for (auto& kept : kept_of(s.times)) s.skipped_now.push_back(std::move(kept));
  return {};
}

void LiveSession::build_aside(bool aside) { state_->aside = aside; }
bool LiveSession::waits() const { return state_->waits; }

Result<bool> LiveSession::time_a_kernel() {
  State& s = *state_;
  Program* const program = s.alive();
  if (!program || program->plan().kernels.empty()) return false;
  const auto& kernels = program->plan().kernels;
  if (s.timed.program != program->id()) {
    std::vector<KernelTime> times;  // those of kernels that an edit has left alone are as good as before
    for (const auto& kernel : kernels) {
      const auto known = std::ranges::find(s.timed.times, kernel.name, &KernelTime::name);
      times.push_back({kernel.name, known == s.timed.times.end() ? -1 : known->milliseconds});
    }
    s.timed = {.program = program->id(), .next = 0, .all = false, .times = std::move(times)};
  }
  const std::size_t kernel = s.timed.next;
  AFTERGLOW_TRY(const auto milliseconds, s.runner->time_kernel(*program, kernel));
  if (!milliseconds) return false;
  s.timed.times[kernel].milliseconds = *milliseconds;
  s.timed.next = (kernel + 1) % kernels.size();
  s.timed.all = s.timed.all || s.timed.next == 0;
  return true;
}

std::vector<KernelTime> LiveSession::kernel_times() const {
  std::vector<KernelTime> known;
  for (const auto& time : state_->timed.times)
    if (time.milliseconds >= 0) known.push_back(time);
  return known;
}

bool LiveSession::all_timed() const {
  const State& s = *state_;
  const Program* program = s.alive();
  return !program || program->plan().kernels.empty() || (s.timed.program == program->id() && s.timed.all);
}

std::vector<Skipped> LiveSession::skipped() const {
  const State& s = *state_;
  std::vector<Skipped> out;
  if (const Stack* stack = s.live->stack()) out = stack->skipped();
  out.insert(out.end(), s.skipped_now.begin(), s.skipped_now.end());
  return out;
}

std::vector<std::string> LiveSession::kernels() const {
  std::vector<std::string> names;
  if (const Program* ran = state_->alive())
    for (const auto& kernel : ran->plan().kernels) names.push_back(kernel.name);
  return names;
}

ProgramMemory LiveSession::memory() const {
  Stack* stack = state_->live->stack();
  const Program* program = stack ? stack->program() : nullptr;
  return program ? program->memory() : ProgramMemory{};
}

}  // namespace afterglow
