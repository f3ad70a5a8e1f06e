// SPDX-License-Identifier: MIT
// How frames begin: their images are made, filled, and what runs is submitted.
#include <algorithm>
#include <utility>

#include "core/beside.h"
#include "core/exception.h"
#include "exec/frame_runner_state.h"

namespace afterglow {

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
  auto done = without_exceptions(all);
  return done ? std::move(done) : given_up(std::move(done));
}

/// Begins a frame whose pixels another thread converts meanwhile.
Result<void> FrameRunner::State::begin_packing(Program& program, const std::map<std::string, HostImage>& host,
                                               const Choose& choose) {
  if (auto prepared = without_exceptions([&] { return prepare(program, host); }); !prepared)
    return given_up(std::move(prepared));
  packing.emplace(&program, host, choose);
  packing->uploaded = beside([this, &program, &own = packing->host, look = choose.look] {
    return without_exceptions([&] { return upload(program, own, look); });
  });
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
  forget_result();
  begun->submitted.reset();
  begun->failed = std::move(done).error();
}

/// Nothing may be on its way between images that are made anew.
Result<void> FrameRunner::State::given_up(Result<void> failed) {
  (void)submitter.wait();
  forget_result();
  begun.reset();
  return failed;
}

/// Nothing is left of a result that cannot be read. `part` is a copy: `shown` goes then.
Result<std::uint64_t> FrameRunner::State::read_back(Rect part, HostResult& out, bool look_for_flags) {
  auto held = without_exceptions([&] { return images.result.download(images.staging, part, out, look_for_flags); });
  if (!held) forget_result();
  return held;
}

/// Of a frame that failed: parts of it may be on their way back, and the image be left as they found it.
void FrameRunner::State::forget_result() {
  (void)images.staging.wait();
  images.result.set_writer(0);
  shown.reset();
}

}  // namespace afterglow
