// SPDX-License-Identifier: MIT
#include "exec/frame_runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <future>
#include <utility>

#include "core/exception.h"
#include "core/stopwatch.h"
#include "exec/convert.h"
#include "exec/frame_images.h"
#include "exec/host_input.h"
#include "exec/kernel_timer.h"
#include "exec/submit.h"
#include "gpu/error.h"

namespace afterglow {

struct FrameRunner::State {
  State(Device& device_in, const FrameImages::Options& options, int place_in)
      : device(device_in), place(place_in), images(device_in, options), timer(device_in) {}

  Device& device;
  int place;
  FrameImages images;
  bool flags = false;         ///< the last run's result tells of what is not finite
  std::optional<Rect> shown;  ///< the part of the result that the last run made; none: the result is the source
  KernelTimer timer;
  /// What the command buffer holds and what it needs to be so again.
  struct Recorded {
    std::uint64_t program = 0;
    std::vector<bool> run;
    FrameImages::Handles images;
    std::vector<VkImageLayout> layouts;  ///< of the inputs, before and after
    int bindings = 0;
    friend bool operator==(const Recorded&, const Recorded&) = default;
  };
  static constexpr int kOneOff = 2;                       ///< buffer of the Submitter for what is submitted once
  std::array<std::optional<Recorded>, kOneOff> recorded;  ///< by Program::recording
  /// What a program is bound to: the images, and its own count then.
  struct Bound {
    std::uint64_t program = 0;
    FrameImages::Handles images;
    int bindings = 0;
    friend bool operator==(const Bound&, const Bound&) = default;
  };
  std::optional<Bound> bound;
  /// A frame that began.
  struct Begun {
    Program* ran = nullptr;  ///< null: the result is the source
    HostImage source;
    FrameTimes times;
    Plan plan{};                                   ///< of `ran`, for messages
    Program* running = nullptr;                    ///< what was submitted
    std::uint64_t runaways = 0;                    ///< of it, when the frame began
    std::optional<Clock::time_point> submitted{};  ///< none: its kernels have been waited for
    std::optional<Error> failed{};                 ///< as was found then
  };
  std::optional<Begun> begun;
  Program* warming_up = nullptr;  ///< whose pixels `warm_up` submitted, which have not been waited for
  Submitter submitter;            // it waits before the images go
  /// A frame that began, whose pixels are being converted by another thread. It touches nothing but the images.
  struct Packing {
    Program* program = nullptr;
    std::map<std::string, HostImage> host;
    Choose choose;
    std::future<Result<double>> uploaded{};  ///< how long it took; ends before the rest goes

    Packing(Program* program_in, const std::map<std::string, HostImage>& host_in, const Choose& choose_in)
        : program(program_in), host(host_in), choose(choose_in) {}
  };
  std::optional<Packing> packing;  // last: its thread uses the others

  Result<void> leave_readable();
  Result<void> begin(Program& program, const std::map<std::string, HostImage>& host, KernelTiming timing,
                     const Choose& choose);
  Result<void> begin_packing(Program& program, const std::map<std::string, HostImage>& host, const Choose& choose);
  void launch_packed();
  Result<void> begin_download();
  Result<void> prepare(Program& program, const std::map<std::string, HostImage>& host);
  Result<double> upload(const Program& program, const std::map<std::string, HostImage>& host, bool look);
  Result<void> launch(Program& program, KernelTiming timing, const Choose& choose);
  Result<void> given_up(Result<void> failed);
  Result<void> execute(Program& program, const std::vector<bool>& run, KernelTiming timing);
  Result<void> time_separately(Program& program, const std::vector<bool>& run);
  Result<void> wait();
  Result<FrameTimes> end();
};

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

FrameRunner::FrameRunner(std::unique_ptr<State> state) : state_(std::move(state)) {}
FrameRunner::~FrameRunner() = default;

Result<std::unique_ptr<FrameRunner>> FrameRunner::create(Device& device, const Options& options) {
  const FrameImages::Options images{options.max_memory, options.direct && device.maps_images(), options.whole_staging};
  auto state = std::make_unique<State>(device, images, options.place);
  AFTERGLOW_TRY(state->submitter, Submitter::create(device));
  return std::unique_ptr<FrameRunner>(new FrameRunner(std::move(state)));
}

/// What is otherwise done after the kernels, when none has run.
Result<void> FrameRunner::State::leave_readable() {
  if (images.inputs.readable()) return {};
  AFTERGLOW_CHECK(submitter.submit([&](VkCommandBuffer commands) { images.inputs.after(commands); }, kOneOff));
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
                         : submitter.submit(
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
    auto done = submitter.submit(
        [&](VkCommandBuffer commands) { program.record_again(commands, i, VK_NULL_HANDLE, place); }, kOneOff);
    if (done) done = submitter.wait();
    if (!done) {
      Error error = std::move(done).error();
      error.message += fmt::format(" in kernel '{}'", kernels[i].name);
      return error;
    }
    begun->times.kernels.push_back({kernels[i].name, milliseconds_since(begin)});
  }
  AFTERGLOW_CHECK(submitter.submit(
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
    warmed->forget_runaways();  // it read images that nobody had filled
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

/// A frame begins: its images are made.
Result<void> FrameRunner::State::prepare(Program& program, const std::map<std::string, HostImage>& host) {
  launch_packed();
  begun = Begun{};
  shown.reset();
  const auto warming = Clock::now();
  AFTERGLOW_CHECK(wait());
  begun->times.execute = milliseconds_since(warming);
  AFTERGLOW_CHECK(images.prepare(program, host));
  begun->source = host.at("source");
  return {};
}

/// Returns how long it took.
Result<double> FrameRunner::State::upload(const Program& program, const std::map<std::string, HostImage>& host,
                                          bool look) {
  const auto began = Clock::now();
  AFTERGLOW_CHECK(images.upload(program, host, look));
  return milliseconds_since(began);
}

/// Everything of a frame that has been uploaded but waiting for it and reading it back.
Result<void> FrameRunner::State::launch(Program& program, KernelTiming timing, const Choose& choose) {
  Program* chosen = &program;
  if (choose.program) {
    AFTERGLOW_TRY(chosen, choose.program(choose.look ? images.inputs.found("source") : SourceContent{}));
  }
  if (!chosen) return {};
  if (chosen != &program) AFTERGLOW_CHECK(images.take_result(*chosen));
  const std::vector<bool> run = chosen->begin_run(images.inputs.versions(), images.result.writer() != chosen->id());
  begun->times.kernels_run = static_cast<int>(std::ranges::count(run, true));
  begun->times.kernels_kept = static_cast<int>(run.size()) - begun->times.kernels_run;
  if (begun->times.kernels_run > 0) {
    images.result.set_writer(0);
    begun->plan = chosen->plan();
    begun->running = chosen;
    begun->runaways = chosen->runaways();
    AFTERGLOW_CHECK(execute(*chosen, run, timing));
    chosen->up_to_date();
    images.result.set_writer(chosen->id());
  }
  begun->ran = chosen;
  shown = chosen->parts().images[chosen->graph().result];
  flags = chosen->flags_non_finite();
  return {};
}

/// With whole staging buffers the result is on its way back before anybody waits for it.
Result<void> FrameRunner::State::begin_download() {
  if (!images.whole_staging() || !begun->ran) return {};
  return images.result.begin_download(images.staging, *shown);
}

Result<void> FrameRunner::State::begin(Program& program, const std::map<std::string, HostImage>& host,
                                       KernelTiming timing, const Choose& choose) {
  const auto all = [&]() -> Result<void> {
    AFTERGLOW_CHECK(prepare(program, host));
    AFTERGLOW_TRY(begun->times.upload, upload(program, host, choose.look));
    return launch(program, timing, choose);
  };
  auto done = all();
  return done ? std::move(done) : given_up(std::move(done));
}

/// Begins a frame whose pixels another thread converts meanwhile.
Result<void> FrameRunner::State::begin_packing(Program& program, const std::map<std::string, HostImage>& host,
                                               const Choose& choose) {
  if (auto prepared = prepare(program, host); !prepared) return given_up(std::move(prepared));
  packing.emplace(&program, host, choose);
  const auto pack = [this, &program, &own = packing->host, look = choose.look] {
    return without_exceptions([&] { return upload(program, own, look); });
  };
  try {
    packing->uploaded = std::async(std::launch::async, pack);
  } catch (const std::exception&) {  // no more threads to be had
    packing->uploaded = std::async(std::launch::deferred, pack);
  }
  return {};
}

/// Goes on with such a frame. What fails is told when it is waited for.
void FrameRunner::State::launch_packed() {
  if (!packing) return;
  packing->uploaded.wait();
  Packing packed = *std::exchange(packing, std::nullopt);
  const auto all = [&]() -> Result<void> {
    AFTERGLOW_TRY(begun->times.upload, packed.uploaded.get());
    AFTERGLOW_CHECK(launch(*packed.program, KernelTiming::none, packed.choose));
    return begin_download();
  };
  auto done = without_exceptions(all);
  if (done) return;
  (void)submitter.wait();
  (void)images.staging.wait();
  begun->submitted.reset();
  begun->failed = std::move(done).error();
}

/// Nothing may be on its way between images that are made anew.
Result<void> FrameRunner::State::given_up(Result<void> failed) {
  (void)submitter.wait();
  (void)images.staging.wait();
  begun.reset();
  return failed;
}

Result<FrameTimes> FrameRunner::State::end() {
  auto done = wait();
  FrameTimes times = begun ? std::move(begun->times) : FrameTimes{};
  if (!done) return std::move(done).error();
  return times;
}

Result<void> FrameRunner::begin(Program& program, const std::map<std::string, HostImage>& inputs, KernelTiming timing,
                                const Choose& choose) {
  State& s = *state_;
  if (s.images.whole_staging() && timing == KernelTiming::none) return s.begin_packing(program, inputs, choose);
  AFTERGLOW_CHECK(s.begin(program, inputs, timing, choose));
  auto read_back = s.begin_download();
  return read_back ? std::move(read_back) : s.given_up(std::move(read_back));
}

void FrameRunner::launch() { state_->launch_packed(); }

Result<void> FrameRunner::warm_up(Program& program, bool backwards) {
  State& s = *state_;
  AFTERGLOW_CHECK(s.wait());
  if (program.plan().kernels.empty()) return {};
  AFTERGLOW_CHECK(s.images.prepare(program, usual_inputs(program.graph())));
  s.bound.reset();
  s.images.result.set_writer(0);
  AFTERGLOW_CHECK(program.bind(s.images.inputs.bindings(), binding_of(s.images.result.image()), s.place));
  AFTERGLOW_CHECK(s.submitter.submit(
      [&](VkCommandBuffer commands) {
        s.images.inputs.before(program, commands);
        s.images.result.before(commands);
        program.record_a_pixel_each(commands, backwards, s.place);
        s.images.inputs.after(commands);
        s.images.result.after(commands);
      },
      State::kOneOff));
  s.warming_up = &program;
  return {};
}

Result<void> FrameRunner::wait() {
  auto done = state_->wait();
  return state_->begun && state_->begun->failed ? Result<void>() : done;
}
void FrameRunner::forget_result() { state_->images.result.set_writer(0); }

Result<FrameTimes> FrameRunner::finish(HostResult& out) {
  State& s = *state_;
  out.clamped = 0;
  out.flagged = false;
  if (!s.begun) return Error{ErrorKind::other, "no frame began"};
  s.launch_packed();
  Program* const ran = s.begun->ran;
  const HostImage source = s.begun->source;
  auto ended = s.end();
  if (!ended) {
    (void)s.images.staging.wait();  // a download may be on its way
    return std::move(ended).error();
  }
  FrameTimes times = std::move(*ended);
  out.clamped = s.images.inputs.clamped();
  if (!ran) {
    s.begun.reset();
    copy_source(source, out);
    return times;
  }
  const auto start = Clock::now();
  AFTERGLOW_TRY(const std::uint64_t held, s.images.result.download(s.images.staging, *s.shown, out, s.flags));
  s.begun.reset();
  out.clamped += held;
  times.readback = milliseconds_since(start);
  return times;
}

Result<FrameTimes> FrameRunner::run(Program& program, const std::map<std::string, HostImage>& inputs, HostResult& out,
                                    KernelTiming timing, const Choose& choose) {
  const Graph& graph = program.graph();
  if (graph.result == graph.source) {
    state_->shown.reset();
    out.clamped = 0;
    out.flagged = false;
    AFTERGLOW_CHECK(check_input(graph, "source", graph.source, inputs));
    copy_source(inputs.at("source"), out);
    return FrameTimes{};
  }
  AFTERGLOW_CHECK(begin(program, inputs, timing, choose));
  return finish(out);
}

Result<FrameTimes> FrameRunner::run_on_device(Program* program, const std::map<std::string, HostImage>& inputs,
                                              KernelTiming timing, const Choose& choose) {
  State& s = *state_;
  FrameTimes times;
  bool ran = false;
  if (program && program->graph().result != program->graph().source) {
    AFTERGLOW_CHECK(s.begin(*program, inputs, timing, choose));
    ran = s.begun->ran != nullptr;
    AFTERGLOW_TRY(times, s.end());
  } else {
    s.shown.reset();
    AFTERGLOW_TRY(times.upload, s.images.bring_source(inputs));
  }
  s.begun.reset();
  if (!ran) AFTERGLOW_CHECK(s.leave_readable());
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
  AFTERGLOW_CHECK(s.submitter.submit(
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

DeviceImages FrameRunner::images() const { return state_->images.on_device(state_->shown.has_value()); }

Result<void> FrameRunner::read_result(HostResult& out, const std::optional<Rect>& part) {
  if (!state_->shown) return Error{ErrorKind::other, "no frame was run, there is no result to read"};
  AFTERGLOW_TRY(out.clamped,
                state_->images.result.download(state_->images.staging, part.value_or(*state_->shown), out));
  return {};
}

Result<HostResult> FrameRunner::read_image(Program& program, ImageId image) {
  const auto found = program.transient(image);
  if (!found || !found->kept) {
    const auto& images = program.graph().images;
    const bool known = image >= 0 && image < static_cast<int>(images.size());
    return Error{ErrorKind::other,
                 fmt::format("the pixels of '{}' are not kept", known ? images[image].name : std::to_string(image))};
  }
  const auto [width, height] = found->binding.size;
  HostResult out;
  out.pixels.resize(static_cast<std::size_t>(found->binding.size.area()) * 4);
  const auto unpack = [&, w = width](int y, const std::byte* from) {
    return unpack_row(from, found->binding.format, w, out.pixels.data() + static_cast<std::ptrdiff_t>(y) * w * 4);
  };
  AFTERGLOW_TRY(out.clamped,
                state_->images.staging.download({found->binding.image, found->binding.format, found->binding.size},
                                                found->layout, unpack));
  return out;
}

FrameRunner::Counters FrameRunner::counters() const {
  return {.images = state_->images.made(),
          .buffers = state_->images.staging.buffers() + state_->timer.pools(),
          .recordings = state_->submitter.recordings()};
}

}  // namespace afterglow
