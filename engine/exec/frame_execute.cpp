// SPDX-License-Identifier: MIT
// What frames submit, how it is waited for and timed.
#include <fmt/format.h>

#include <utility>

#include "core/exception.h"
#include "exec/frame_runner_state.h"

namespace afterglow {
namespace {

bool makes_result(const Program& program, std::size_t kernel) {
  return program.plan().kernels[kernel].output == program.graph().result;
}

/// A result that is not made anew keeps its pixels, and so its layout.
bool makes_result(const Program& program, const std::vector<bool>& run) {
  for (std::size_t kernel = 0; kernel < run.size(); ++kernel)
    if (run[kernel] && makes_result(program, kernel)) return true;
  return false;
}

}  // namespace

/// Layouts are those behind what was submitted: when that fails, those before it.
Result<void> FrameRunner::State::submit(const std::function<void(VkCommandBuffer)>& record, int which) {
  const std::vector<VkImageLayout> layouts = images.inputs.layouts();
  const VkImageLayout layout = images.result.image().layout;
  auto done = without_exceptions([&] { return submitter.submit(record, which); });
  if (done) return done;
  images.inputs.set_layouts(layouts);
  images.result.set_layout(layout);
  return done;
}

/// What is otherwise done after the kernels, when none has run.
Result<void> FrameRunner::State::leave_readable() {
  if (images.inputs.readable()) return {};
  AFTERGLOW_CHECK(submit([&](VkCommandBuffer commands) { images.inputs.after(commands); }, kOneOff));
  return submitter.wait();
}

/// Submits; with `timing` it also waits.
Result<void> FrameRunner::State::execute(Program& program, const std::vector<bool>& run, KernelTiming timing) {
  const auto& kernels = program.plan().kernels;
  const bool separate = timing == KernelTiming::submissions;
  const bool stamps = timing == KernelTiming::timestamps && device.timestamps_mean_draws();
  const bool draws_result = makes_result(program, run);
  VkQueryPool queries = VK_NULL_HANDLE;
  if (stamps) {
    AFTERGLOW_TRY(queries, timer.queries(kernels.size() + 1));
  }

  Recorded wanted{.program = program.id(),
                  .run = run,
                  .images = images.handles(),
                  .layouts = images.inputs.layouts(),
                  .bindings = program.bindings(place)};
  const bool unlike = program.recording() == Program::kUnlikeOthers;
  const int which = unlike ? kOneOff : program.recording();
  std::optional<Recorded> none;
  std::optional<Recorded>& last = unlike ? none : recorded[static_cast<std::size_t>(which)];
  const bool known = timing == KernelTiming::none && last == wanted;
  if (!known) {
    if (bound != Bound{program.id(), wanted.images, program.bindings(place)})
      AFTERGLOW_CHECK(program.bind(images.inputs.bindings(), binding_of(images.result.image()), place));
    bound = {program.id(), wanted.images, program.bindings(place)};
    wanted.bindings = program.bindings(place);
  }
  last.reset();
  begun->submitted = Clock::now();
  auto submitted = known ? submitter.submit_again(which)
                         : submit(
                               [&](VkCommandBuffer commands) {
                                 images.inputs.before(program, commands);
                                 if (draws_result) images.result.before(commands);
                                 program.record(commands, queries, run, place);
                                 if (separate) return;
                                 images.inputs.after(commands);
                                 if (draws_result) images.result.after(commands);
                               },
                               which);
  if (!submitted) return KernelTimer::blame(std::move(submitted).error(), program.plan());
  // Layouts are where they were when the frame ends as it began.
  if (timing == KernelTiming::none && images.inputs.layouts() == wanted.layouts) last = std::move(wanted);
  if (timing == KernelTiming::none) return {};
  AFTERGLOW_CHECK(wait());
  if (stamps) {
    AFTERGLOW_TRY(begun->times.kernels, timer.read(program.plan()));
  }
  return separate ? time_separately(program, run) : Result<void>();
}

/// Each kernel once more, alone: the same pixels again, since no input has changed.
Result<void> FrameRunner::State::time_separately(Program& program, const std::vector<bool>& run) {
  const auto& kernels = program.plan().kernels;
  begun->times.separate_submissions = true;
  for (std::size_t i = 0; i < kernels.size(); ++i) {
    if (!run[i]) continue;
    const auto begin = Clock::now();
    auto done =
        submit([&](VkCommandBuffer commands) { program.record_again(commands, i, VK_NULL_HANDLE, place); }, kOneOff);
    if (done) done = submitter.wait();
    if (!done) {
      Error error = std::move(done).error();
      error.message += fmt::format(" in kernel '{}'", kernels[i].name);
      return error;
    }
    begun->times.kernels.push_back({kernels[i].name, milliseconds_since(begin)});
  }
  AFTERGLOW_CHECK(submit(
      [&](VkCommandBuffer commands) {
        images.inputs.after(commands);
        if (makes_result(program, run)) images.result.after(commands);
      },
      kOneOff));
  return submitter.wait();
}

/// The one place that waits for kernels. Once a frame has failed it says so each time.
Result<void> FrameRunner::State::wait() {
  launch_packed();
  if (Program* const warmed = std::exchange(warming_up, nullptr)) {
    AFTERGLOW_CHECK(submitter.wait());
    AFTERGLOW_CHECK(warmed->forget_runaways());  // it read images that nobody had filled
  }
  if (!begun) return {};
  if (!begun->submitted) return begun->failed ? Result<void>(*begun->failed) : Result<void>();
  const auto since = *std::exchange(begun->submitted, std::nullopt), waiting = Clock::now();
  auto done = submitter.wait();
  begun->times.waited += milliseconds_since(waiting);
  begun->times.execute += milliseconds_since(since);
  auto ended = done && begun->running ? begun->running->check_loops(begun->runaways) : Result<void>();
  if (done && ended) return {};
  images.result.set_writer(0);
  if (!done) {
    recorded = {};
    ended = KernelTimer::blame(std::move(done).error(), begun->plan);
  }
  begun->failed = ended.error();
  return ended;
}

Result<FrameTimes> FrameRunner::State::end() {
  auto done = wait();
  FrameTimes times = begun ? std::move(begun->times) : FrameTimes{};
  if (!done) return std::move(done).error();
  return times;
}

Result<std::optional<double>> FrameRunner::time_kernel(Program& program, std::size_t kernel) {
  State& s = *state_;
  const State::Bound bound{program.id(), s.images.handles(), program.bindings(s.place)};
  if (s.images.result.writer() != program.id() || s.bound != bound || kernel >= program.plan().kernels.size())
    return std::optional<double>();
  const bool draws_result = makes_result(program, kernel);
  const bool stamps = s.device.timestamps_mean_draws();
  VkQueryPool queries = VK_NULL_HANDLE;
  if (stamps) {
    AFTERGLOW_TRY(queries, s.timer.queries(2));
  }
  const auto start = Clock::now();
  AFTERGLOW_CHECK(s.submit(
      [&](VkCommandBuffer commands) {
        s.images.inputs.before(program, commands);
        if (draws_result) s.images.result.before(commands);
        program.record_again(commands, kernel, queries, s.place);
        s.images.inputs.after(commands);
        if (draws_result) s.images.result.after(commands);
      },
      State::kOneOff));
  AFTERGLOW_CHECK(s.submitter.wait());
  if (!stamps) return std::optional<double>(milliseconds_since(start));
  AFTERGLOW_TRY(const double between, s.timer.between());
  return std::optional<double>(between);
}

}  // namespace afterglow
