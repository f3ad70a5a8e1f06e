// SPDX-License-Identifier: MIT
#include "exec/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "exec/frame_runner.h"
#include "exec/host_input.h"

namespace afterglow {

struct Renderer::State {
  explicit State(Device& device_in) : device(device_in) {}

  /// What one frame in flight has of its own.
  struct Slot {
    std::unique_ptr<FrameRunner> runner;
    FrameReport report;
    HostImage untouched{};  ///< the source of a frame that runs nothing
    bool runs = false;
  };
  Device& device;
  std::vector<Slot> slots;
  std::size_t oldest = 0;  ///< slot of the frame that is collected next
  std::size_t used = 0;    ///< frames in flight, from there on

  void launch_all();
  Slot& next() { return slots[(oldest + used) % slots.size()]; }
  Result<void> wait();
  /// The program for `look`ed-at frames; notes what it leaves out.
  ChooseProgram choose(const RenderRequest& request, Program& program, Slot& slot);
  Result<Program*> take_program(RenderRequest& request, Slot& slot);
  void forget_results_but_of(const Slot& slot);
};

Renderer::Renderer(std::unique_ptr<State> state) : state_(std::move(state)) {}
Renderer::~Renderer() = default;

Result<std::unique_ptr<Renderer>> Renderer::create(Device& device, const RendererOptions& options) {
  auto state = std::make_unique<State>(device);
  const bool direct = options.direct && device.maps_images();
  state->slots.resize(direct ? 1 : static_cast<std::size_t>(std::max(options.frames, 1)));
  for (std::size_t i = 0; i < state->slots.size(); ++i) {
    const FrameRunner::Options own{.max_memory = options.max_memory,
                                   .direct = direct,
                                   .whole_staging = state->slots.size() > 1,
                                   .place = static_cast<int>(i)};
    AFTERGLOW_TRY(state->slots[i].runner, FrameRunner::create(device, own));
  }
  return std::unique_ptr<Renderer>(new Renderer(std::move(state)));
}

int Renderer::frames() const { return static_cast<int>(state_->slots.size()); }
int Renderer::in_flight() const { return static_cast<int>(state_->used); }
Result<void> Renderer::wait() { return state_->wait(); }
void Renderer::launch() {
  if (state_->used > 0) state_->slots[state_->oldest].runner->launch();
}

Result<void> Renderer::State::wait() {
  for (std::size_t i = 0; i < slots.size(); ++i) AFTERGLOW_CHECK(slots[(oldest + i) % slots.size()].runner->wait());
  return {};
}

/// Frames that are being packed run the program that their cache holds now.
void Renderer::State::launch_all() {
  for (std::size_t i = 0; i < used; ++i) slots[(oldest + i) % slots.size()].runner->launch();
}

/// A program's own record of what it has made is of the slot that it ran in last.
void Renderer::State::forget_results_but_of(const Slot& slot) {
  for (auto& other : slots)
    if (&other != &slot) other.runner->forget_result();
}

/// The program of the frame, as it is without a look at the content. Null when nothing runs.
Result<Program*> Renderer::State::take_program(RenderRequest& request, Slot& slot) {
  slot.report = {};
  if (!request.programs) return nullptr;
  ProgramCache& programs = *request.programs;
  if (!programs.has(request.work)) AFTERGLOW_CHECK(wait());
  AFTERGLOW_CHECK(programs.find(std::move(request.work), *request.shaders));
  Program* const program = programs.program();
  if (program) {
    slot.report.memory = program->memory();
    return program;
  }
  AFTERGLOW_CHECK(wait());
  AFTERGLOW_CHECK(programs.begin());
  return nullptr;
}

ChooseProgram Renderer::State::choose(const RenderRequest& request, Program& program, Slot& slot) {
  ProgramCache& programs = *request.programs;
  ShaderLibrary& shaders = *request.shaders;
  const bool look = programs.depends_on_content();
  const auto ask = [this, &programs, &shaders, &program, &slot,
                    look](const SourceContent& content) -> Result<Program*> {
    AFTERGLOW_CHECK(wait());
    AFTERGLOW_CHECK(programs.begin());
    Program* chosen = &program;
    if (look) {
      AFTERGLOW_TRY(ProgramCache::Choice choice, programs.for_content(content, shaders));
      slot.report.skipped = std::move(choice.skipped);
      chosen = choice.program;
    }
    if (!chosen) return chosen;
    slot.report.program = chosen->id();
    for (const auto& kernel : chosen->plan().kernels) slot.report.kernels.push_back(kernel.name);
    return chosen;
  };
  return {.program = ask, .look = look};
}

namespace {

/// What the frame did not do because it was done before.
void add_kept(FrameReport& report) {
  const FrameTimes& times = report.times;
  if (times.kernels_kept == 0) return;
  if (times.kernels_run == 0)
    report.skipped.push_back({"frame", "its picture and settings are those of an earlier frame"});
  else
    report.skipped.push_back(
        {fmt::format("{} of {} kernels", times.kernels_kept, times.kernels_kept + times.kernels_run),
         "nothing that they read has changed"});
}

}  // namespace

Result<Program*> Renderer::warm_up(ProgramCache& programs, ShaderLibrary& shaders) {
  State& s = *state_;
  if (!s.device.is_cpu()) return nullptr;
  AFTERGLOW_TRY(Program* const program, programs.usual(shaders));
  if (program) AFTERGLOW_CHECK(s.next().runner->warm_up(*program));
  return program;
}

Result<void> Renderer::submit(RenderRequest request) {
  State& s = *state_;
  if (s.used == s.slots.size()) return Error{ErrorKind::other, "the frame before has to be collected first"};
  if (request.timing != KernelTiming::none) AFTERGLOW_CHECK(s.wait());
  s.launch_all();
  State::Slot& slot = s.next();
  AFTERGLOW_TRY(Program* const program, s.take_program(request, slot));
  slot.runs = program != nullptr;
  if (program) {
    AFTERGLOW_CHECK(slot.runner->begin(*program, request.inputs, request.timing, s.choose(request, *program, slot)));
    s.forget_results_but_of(slot);
  } else {
    const auto source = request.inputs.find("source");
    if (source == request.inputs.end() || (!source->second.pixels && !source->second.read_row))
      return Error{ErrorKind::other, "the frame has no image 'source'"};
    slot.untouched = source->second;
  }
  ++s.used;
  return {};
}

Result<FrameReport> Renderer::collect(HostResult& out) {
  State& s = *state_;
  if (s.used == 0) return Error{ErrorKind::other, "no frame is in flight"};
  State::Slot& slot = s.slots[s.oldest];
  --s.used;
  if (s.used > 0) s.oldest = (s.oldest + 1) % s.slots.size();  // else one slot is enough
  if (!slot.runs) {
    out.clamped = 0;
    out.flagged = false;
    copy_source(slot.untouched, out);
    return std::move(slot.report);
  }
  AFTERGLOW_TRY(slot.report.times, slot.runner->finish(out));
  add_kept(slot.report);
  return std::move(slot.report);
}

Result<FrameReport> Renderer::render(RenderRequest request, HostResult& out) {
  AFTERGLOW_CHECK(submit(std::move(request)));
  return collect(out);
}

Result<FrameReport> Renderer::show(RenderRequest request) {
  State& s = *state_;
  AFTERGLOW_CHECK(s.wait());
  State::Slot& slot = s.slots[s.oldest];
  AFTERGLOW_TRY(Program* const program, s.take_program(request, slot));
  const ChooseProgram choose = program ? s.choose(request, *program, slot) : ChooseProgram{};
  AFTERGLOW_TRY(slot.report.times, slot.runner->run_on_device(program, request.inputs, request.timing, choose));
  add_kept(slot.report);
  return std::move(slot.report);
}

DeviceImages Renderer::images() const { return state_->slots[state_->oldest].runner->images(); }

Result<void> Renderer::read_result(HostResult& out, const std::optional<Rect>& part) {
  return state_->slots[state_->oldest].runner->read_result(out, part);
}

Result<std::optional<double>> Renderer::time_kernel(Program& program, std::size_t kernel) {
  return state_->slots[state_->oldest].runner->time_kernel(program, kernel);
}

Result<FrameTimes> Renderer::run(Program& program, const std::map<std::string, HostImage>& inputs, HostResult& out) {
  State& s = *state_;
  if (s.used > 0) return Error{ErrorKind::other, "frames are in flight"};
  return s.slots[s.oldest].runner->run(program, inputs, out, KernelTiming::none);
}

Result<HostResult> Renderer::read_image(Program& program, ImageId image) {
  return state_->slots[state_->oldest].runner->read_image(program, image);
}

Renderer::Counters Renderer::counters() const {
  Counters sum;
  for (const auto& slot : state_->slots) {
    const auto one = slot.runner->counters();
    sum.images += one.images;
    sum.buffers += one.buffers;
    sum.recordings += one.recordings;
  }
  return sum;
}

}  // namespace afterglow
