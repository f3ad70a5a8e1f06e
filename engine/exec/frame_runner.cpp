// SPDX-License-Identifier: MIT
#include "exec/frame_runner.h"

#include <fmt/format.h>

#include <utility>

#include "core/exception.h"
#include "exec/convert.h"
#include "exec/frame_runner_state.h"
#include "exec/host_input.h"

namespace afterglow {

FrameRunner::FrameRunner(std::unique_ptr<State> state) : state_(std::move(state)) {}
FrameRunner::~FrameRunner() = default;

Result<std::unique_ptr<FrameRunner>> FrameRunner::create(Device& device, const Options& options) {
  const FrameImages::Options images{options.max_memory, options.direct && device.maps_images(), options.whole_staging};
  auto state = std::make_unique<State>(device, images, options.place);
  AFTERGLOW_TRY(state->submitter, Submitter::create(device));
  return std::unique_ptr<FrameRunner>(new FrameRunner(std::move(state)));
}

Result<void> FrameRunner::begin(Program& program, const std::map<std::string, HostImage>& inputs, KernelTiming timing,
                                const Choose& choose) {
  State& s = *state_;
  if (s.images.whole_staging() && timing == KernelTiming::none) return s.begin_packing(program, inputs, choose);
  AFTERGLOW_CHECK(s.begin(program, inputs, timing, choose));
  auto read_back = without_exceptions([&] { return s.begin_download(); });
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
  AFTERGLOW_CHECK(s.submit(
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
    s.forget_result();
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
  auto held = s.read_back(*s.shown, out, s.flags);
  s.begun.reset();
  if (!held) return std::move(held).error();
  out.clamped += *held;
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
    auto brought = without_exceptions([&] { return s.images.bring_source(inputs); });
    if (!brought) return s.given_up(std::move(brought).error()).error();
    times.upload = *brought;
  }
  s.begun.reset();
  if (!ran) AFTERGLOW_CHECK(s.leave_readable());
  return times;
}

DeviceImages FrameRunner::images() const { return state_->images.on_device(state_->shown.has_value()); }

Result<void> FrameRunner::read_result(HostResult& out, const std::optional<Rect>& part) {
  if (!state_->shown) return Error{ErrorKind::other, "no frame was run, there is no result to read"};
  AFTERGLOW_TRY(out.clamped, state_->read_back(part.value_or(*state_->shown), out, false));
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
