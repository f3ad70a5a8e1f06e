#include "session/live_session.h"

#include "session/picture_inputs.h"

namespace afterglow {

struct LiveSession::State {
  std::unique_ptr<LiveStack> live;
  std::unique_ptr<FrameRunner> runner;  // first to go: it waits for what is in flight
  std::optional<BuildContext> context;  ///< of the last frame
  FrameTimes times;
  std::vector<Skipped> skipped_now;
  Program* ran = nullptr;

  Result<void> prepare(const BuildContext& next);
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

/// The stack as it is now, for this frame.
Result<void> LiveSession::State::prepare(const BuildContext& next) {
  const bool new_shape = !context || context->size != next.size || context->auxiliary != next.auxiliary;
  context = next;
  live->set_context(next);
  if (new_shape) live->settle();
  if (live->update()) ran = nullptr;
  Stack* stack = live->stack();
  if (!stack) return {};
  const FileTrace trace;
  auto prepared = stack->prepare(next);
  live->also_follow(trace.looks());
  return prepared;
}

/// Frames whose content makes effects idle run without them.
FrameRunner::Choose LiveSession::State::choose() {
  if (!live->stack() || !live->stack()->depends_on_content()) return {};
  return [this](float brightest) -> Result<Program*> {
    AFTERGLOW_TRY(const IdlePrograms::Choice choice, live->stack()->program_for(brightest));
    skipped_now = *choice.skipped;
    return ran = choice.program;
  };
}

Result<void> LiveSession::process(const Picture& picture, const BuildContext& frame, KernelTiming timing) {
  State& s = *state_;
  s.ran = nullptr;
  s.skipped_now.clear();
  AFTERGLOW_CHECK(s.prepare(context_of(picture, frame)));
  const Stack* stack = s.live->stack();
  s.ran = stack && stack->runs() ? s.live->stack()->program() : nullptr;
  const auto inputs = picture_inputs(picture, s.ran ? s.ran->graph() : Graph{});
  AFTERGLOW_TRY(s.times, s.runner->run_on_device(s.ran, inputs, timing, s.ran ? s.choose() : FrameRunner::Choose{}));
  for (auto& kept : kept_of(s.times)) s.skipped_now.push_back(std::move(kept));
  return {};
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
  if (state_->ran)
    for (const auto& kernel : state_->ran->plan().kernels) names.push_back(kernel.name);
  return names;
}

ProgramMemory LiveSession::memory() const {
  Stack* stack = state_->live->stack();
  const Program* program = stack ? stack->program() : nullptr;
  return program ? program->memory() : ProgramMemory{};
}

}  // namespace afterglow
