// SPDX-License-Identifier: MIT
#include "session/live_session.h"

#include <algorithm>

#include "session/picture_inputs.h"

namespace afterglow {

struct LiveSession::State {
  std::unique_ptr<LiveStack> live;
  std::unique_ptr<Renderer> renderer;   // first to go: it waits for what is in flight
  std::optional<BuildContext> context;  ///< of the last frame
  FrameReport last;                     ///< of it
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
  Program* alive() const {
    Stack* stack = live->stack();
    return stack && last.program != 0 ? stack->programs()->program(last.program) : nullptr;
  }

  Result<RenderRequest> prepare(const BuildContext& next);
  Result<RenderRequest> request_of(Stack& stack) const;
  bool there_or_late(const FrameWork& work);
};

LiveSession::LiveSession(std::unique_ptr<State> state) : state_(std::move(state)) {}
LiveSession::~LiveSession() = default;

Result<std::unique_ptr<LiveSession>> LiveSession::open(Device& device, const std::filesystem::path& preset,
                                                       const LiveOptions& options, Diagnostics& diagnostics) {
  auto state = std::make_unique<State>();
  AFTERGLOW_TRY(state->live, LiveStack::open(device, preset, options, diagnostics));
  AFTERGLOW_TRY(state->renderer, Renderer::create(device, {.max_memory = options.stack.max_memory}));
  return std::unique_ptr<LiveSession>(new LiveSession(std::move(state)));
}

LiveStack& LiveSession::live() { return *state_->live; }
DeviceImages LiveSession::images() const { return state_->renderer->images(); }
const FrameTimes& LiveSession::times() const { return state_->last.times; }
Renderer::Counters LiveSession::counters() const { return state_->renderer->counters(); }
Result<void> LiveSession::read_result(HostResult& out, const std::optional<Rect>& part) {
  return state_->renderer->read_result(out, part);
}

/// What the stack as it is now runs for this frame: nothing without a stack, and nothing new while `waits`.
Result<RenderRequest> LiveSession::State::prepare(const BuildContext& next) {
  const bool new_shape = !context || context->size != next.size || context->auxiliary != next.auxiliary;
  context = next;
  live->set_context(next);
  if (new_shape) live->settle();
  live->update();
  Stack* stack = live->stack();
  if (!stack) return RenderRequest{};
  auto request = request_of(*stack);
  live->also_follow(stack->preset().probes());
  if (request && aside && !new_shape) waits = !there_or_late(request->work);
  return request;
}

Result<RenderRequest> LiveSession::State::request_of(Stack& stack) const {
  AFTERGLOW_TRY(auto build, stack.evaluate(*context));
  return stack.request(request_for(std::move(build)));
}

/// False when the frame's structure is to be built beside the drawing thread.
bool LiveSession::State::there_or_late(const FrameWork& work) {
  constexpr int kMostMisses = 3;  // then the structure moves faster than builds come
  const ProgramCache& programs = *live->stack()->programs();
  const bool there = programs.has(work) || !work.runs() || !programs.work();
  if (there || misses >= kMostMisses) {
    misses = 0;
    return true;
  }
  if (!live->building()) {
    live->build_for_frame();
    ++misses;
  }
  return false;
}

Result<void> LiveSession::process(const Picture& picture, const BuildContext& frame, KernelTiming timing) {
  State& s = *state_;
  s.waits = false;
  auto request = s.prepare(context_of(picture, frame));
  if (request && s.waits) return {};
  s.last = {};
  if (!request) return std::move(request).error();
  request->inputs = picture_inputs(picture, request->work.graph);
  request->timing = timing;
  AFTERGLOW_TRY(s.last, s.renderer->show(std::move(*request)));
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
  AFTERGLOW_TRY(const auto milliseconds, s.renderer->time_kernel(*program, kernel));
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
  out.insert(out.end(), s.last.skipped.begin(), s.last.skipped.end());
  return out;
}

std::vector<std::string> LiveSession::kernels() const { return state_->last.kernels; }

ProgramMemory LiveSession::memory() const {
  Stack* stack = state_->live->stack();
  const Program* program = stack ? stack->program() : nullptr;
  return program ? program->memory() : ProgramMemory{};
}

}  // namespace afterglow
