#include "apps/frame_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/crop.h"
#include "apps/interrupt.h"
#include "apps/options.h"
#include "apps/resume.h"
#include "apps/scale.h"
#include "core/stopwatch.h"
#include "image/camera.h"
#include "image/facts.h"

namespace afterglow {
namespace {

/// A file that fails spoils its frame; a script, a device or an option that fails would spoil them all.
bool ends_run(const Error& error) { return error.kind != ErrorKind::io && error.kind != ErrorKind::other; }

Error named(Error error, const FrameJob& job) {
  if (error.file.empty()) error.file = job.input.string();
  return error;
}

}  // namespace

struct FrameLoop::Reading {
  FrameRecord* frame = nullptr;
  bool pre_roll = false, restart = false;
  std::optional<Error> refused;  ///< by the header; nothing was read
  BuildContext context;
  std::optional<Size> size;  ///< that the display window is scaled to
  std::optional<Rect> part;  ///< of the picture, when there is a region
  std::optional<DisplayEncoding> encoding;
  ReadOptions options;
  std::future<Result<Picture>> picture;
};

struct FrameLoop::Writing {
  FrameRecord* frame = nullptr;
  std::future<Result<void>> written;
};

FrameLoop::FrameLoop(Session& session, FrameLoopOptions options, Console& console)
    : session_(session), options_(std::move(options)), console_(console) {}

FrameLoop::~FrameLoop() = default;

Result<void> FrameLoop::run(Schedule& schedule) {
  const auto& frames = schedule.frames;
  pre_roll_ = schedule.earlier.size();
  total_ = frames.size() - pre_roll_;
  const auto start = Clock::now();
  std::unique_ptr<Reading> next;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (interrupted()) return close(interrupt_error());
    if (frames.size() > 1)
      console_.progress(i, frames.size(),
                        frames[i].pre_roll ? "before " + frames[i].record->job.output.filename().string()
                                           : frames[i].record->job.output.filename().string(),
                        milliseconds_since(start) / 1000);
    auto reading = next ? std::move(next) : begin_reading(frames[i]);
    // Shaders, pipelines and memory are made while the first picture is read.
    if (i == 0 && !reading->refused) {
      if (auto prepared = session_.prepare(reading->context, reading->encoding, reading->part);
          !prepared && ends_run(prepared.error()))
        return close(fail(*reading->frame, std::move(prepared).error()));
    }
    if (reading->picture.valid()) reading->picture.wait();
    if (overlap_ && i + 1 < frames.size()) next = begin_reading(frames[i + 1]);
    if (auto done = process(*reading); !done) return close(done.error());
    if (!overlap_)
      if (auto done = finish_writing(); !done) return close(done.error());
  }
  return close({});
}

/// Waits for the last output and sums up.
Result<void> FrameLoop::close(Result<void> result) {
  auto last = finish_writing();
  console_.end_progress();
  if (!result) {
    if (result.error().kind == ErrorKind::interrupted && total_ > 1) {
      Error error = result.error();
      error.message = fmt::format("interrupted after {} of {} frames; --resume goes on from there", done_, total_);
      return error;
    }
    return result;
  }
  if (!last) return last;
  if (total_ > 1) non_finite_.sum_up(console_.diagnostics());
  if (failed_ > 0) return Error{ErrorKind::io, fmt::format("{} of {} frames failed", failed_, total_)};
  return {};
}

Result<FrameLoop::Need> FrameLoop::need_of(const PictureHeader& header, const BuildContext& context,
                                           const FrameJob& job) {
  Need need;
  need.reading = header.host_bytes;
  need.result = static_cast<std::uint64_t>(context.size.area()) * 4 * sizeof(float);
  AFTERGLOW_TRY(need.device, session_.stack().memory_needed(context));
  largest_need_ = std::max(largest_need_, need.one_frame());
  if (need.one_frame() > options_.max_memory)
    return Error{ErrorKind::io,
                 fmt::format("{}x{} pixels need about {} with this preset, above --max-memory {}", context.size.width,
                             context.size.height, memory_text(need.one_frame()), memory_text(options_.max_memory)),
                 job.input.string()};
  return need;
}

/// Which frame this one follows: the last of its sequence that was made.
void FrameLoop::place_in_time(Reading& reading) {
  if (!options_.histories) return;
  if (reading.restart) last_.reset();
  reading.context.restart = !last_;
  reading.context.step = last_ ? reading.frame->job.frame - *last_ : 1;
}

std::unique_ptr<FrameLoop::Reading> FrameLoop::begin_reading(const ScheduledFrame& scheduled) {
  auto reading = std::make_unique<Reading>();
  FrameRecord& frame = *scheduled.record;
  reading->frame = &frame;
  reading->pre_roll = scheduled.pre_roll;
  reading->restart = scheduled.restart;
  ReadOptions options = options_.read;
  options.depth = frame.job.depth;
  options.normal = frame.job.normal;
  options.motion = frame.job.motion;
  options.nan_policy = options_.nan_policy;
  reading->options = options;
  const auto header = read_header(frame.job.input, options);
  if (!header) {
    reading->refused = named(header.error(), frame.job);
    return reading;
  }
  const Size display = header->display_window.size();
  BuildContext& context = reading->context;
  context.size = header->data_window.size();
  if (options_.size) {
    reading->size = options_.size->of(display);
    context.size = scaled_size(header->data_window.size(), display, *reading->size);
    context.length_scale =
        std::sqrt(double(reading->size->width) * reading->size->height / (double(display.width) * display.height));
  }
  if (options_.region) {
    const Rect& data = header->data_window;
    const auto& size = reading->size;
    const Rect window = size ? scaled_window(data, header->display_window, *size) : data;
    const Rect shown = size ? Rect{header->display_window.x, header->display_window.y, size->width, size->height}
                            : header->display_window;
    const auto part = part_of_region(*options_.region, window, shown);
    if (!part) {
      reading->refused = named(part.error(), frame.job);
      return reading;
    }
    reading->part = *part;
  }
  for (const auto& name : header->auxiliary)
    if (std::find(options.auxiliary.begin(), options.auxiliary.end(), name) != options.auxiliary.end())
      context.auxiliary[name] = context.size;
  context.frame = frame.job.frame;
  context.fps = options_.fps;
  context.time = frame.job.frame / options_.fps;
  context.position = camera_position(header->facts->metadata);
  if (const auto codes = display_codes(frame.job.output, options_.write, header->has_alpha, header->facts.get()))
    reading->encoding = DisplayEncoding{codes->straight_alpha, codes->dither};
  const auto need = need_of(*header, context, frame.job);
  if (!need) {
    reading->refused = need.error();
    return reading;
  }
  overlap_ = total_ + pre_roll_ > 1 && need->three_frames() <= options_.max_memory;
  reading->picture = std::async(std::launch::async, [this, &frame, options, size = reading->size]() -> Result<Picture> {
    const auto start = Clock::now();
    auto picture = read_picture(frame.job.input, options, console_.diagnostics());
    if (picture && size) scale_picture(*picture, *size);
    if (picture && options_.reuse && total_ + pre_roll_ > 1) note_content(*picture);
    frame.read = milliseconds_since(start);
    return picture;
  });
  return reading;
}

/// From the picture that has been read to one that is being written.
Result<void> FrameLoop::process(Reading& reading) {
  FrameRecord& frame = *reading.frame;
  place_in_time(reading);
  if (reading.refused) return fail(frame, *reading.refused, reading.pre_roll);
  auto picture = reading.picture.get();
  if (!picture) return fail(frame, named(std::move(picture).error(), frame.job), reading.pre_roll);
  if (interrupted()) return interrupt_error();
  frame.size = picture->color.size();
  frame.non_finite.input = picture->non_finite;
  const auto processed = make(reading, *picture);
  // Validation goes first: it says what a failure comes from.
  if (session_.device().validation_errors() > 0)
    return fail(frame, {ErrorKind::device, "Vulkan validation: " + session_.device().validation_messages().front()});
  if (!processed) return fail(frame, named(processed.error(), frame.job), reading.pre_roll);
  last_ = frame.job.frame;
  if (reading.pre_roll) {
    frame.state = FrameRecord::State::done;
    return {};
  }
  const SessionReport report = session_.report();
  frame.times = report.times.frame;
  non_finite_.add(frame.non_finite);
  frame.skipped = report.skipped_now;
  if (report.clamped > 0)
    console_.diagnostics().warn_once(
        "clamped", fmt::format("{}: {} samples were held at ±65504, the largest half float", frame.job.input.string(),
                               report.clamped));
  if (reading.part) crop_picture(*picture, *options_.region, *reading.part);
  if (interrupted()) return interrupt_error();
  AFTERGLOW_CHECK(finish_writing());
  begin_writing(frame, std::move(*picture));
  return {};
}

/// Runs the stack. A frame in which something was not finite is made once more from its file, pass by pass and mended.
Result<void> FrameLoop::make(Reading& reading, Picture& picture) {
  if (options_.nan_policy == NanPolicy::fail) {
    AFTERGLOW_TRY(const Trace trace,
                  session_.trace(picture, reading.context, reading.encoding, reading.part, options_.nan_policy));
    take_findings(reading.frame->non_finite, trace, picture);
    if (!trace.passes.empty())
      return non_finite_error(reading.frame->non_finite.passes.front(), reading.frame->job.input);
  }
  AFTERGLOW_CHECK(session_.process(picture, reading.context, reading.encoding, reading.part));
  const SessionReport report = session_.report();
  const bool overflow = report.clamped > 0 && !non_finite_.overflow_told();
  if (!report.flagged && !overflow) return {};
  return mend(reading, picture);
}

/// Traces the frame from its file: its source is gone, the result took its place.
Result<Trace> FrameLoop::trace_again(const Reading& reading) {
  Diagnostics quiet;  // reading has said all there is to say
  AFTERGLOW_TRY(Picture source, read_picture(reading.frame->job.input, reading.options, quiet));
  if (reading.size) scale_picture(source, *reading.size);
  return session_.trace(source, reading.context, reading.encoding, reading.part, options_.nan_policy);
}

Result<void> FrameLoop::mend(Reading& reading, Picture& picture) {
  FrameRecord& frame = *reading.frame;
  const bool flagged = session_.report().flagged;
  auto traced = trace_again(reading);
  if (!traced && !flagged) return {};  // only a name is missing
  if (!traced) {
    Error error = std::move(traced).error();
    error.message = "values that are not finite came up; the frame could not be made pass by pass: " + error.message;
    return error;
  }
  Trace trace = std::move(traced).value();
  if (trace.overflow) non_finite_.tell_overflow(*trace.overflow, frame.job.input, console_.diagnostics());
  if (!flagged) return {};
  take_findings(frame.non_finite, trace, picture);
  frame.non_finite.untraced = trace.passes.empty();
  non_finite_.tell(frame.non_finite, frame.job.input, options_.nan_policy, console_.diagnostics());
  if (options_.nan_policy == NanPolicy::fail) return Error{ErrorKind::script, kUntraced};
  picture.color = std::move(trace.result);
  picture.codes.clear();
  return {};
}

void FrameLoop::begin_writing(FrameRecord& frame, Picture picture) {
  writing_ = std::make_unique<Writing>();
  writing_->frame = &frame;
  writing_->written = std::async(std::launch::async, [this, &frame, picture = std::move(picture)]() -> Result<void> {
    const auto start = Clock::now();
    auto written = write_picture(picture, frame.job.output, options_.write, console_.diagnostics());
    frame.write = milliseconds_since(start);
    if (written && options_.record_look) return record_made(frame.job, *options_.record_look);
    return written;
  });
}

Result<void> FrameLoop::finish_writing() {
  if (!writing_) return {};
  const auto writing = std::move(writing_);
  auto written = writing->written.get();
  if (!written) return fail(*writing->frame, std::move(written).error());
  writing->frame->state = FrameRecord::State::done;
  ++done_;
  return {};
}

/// Notes the failure; returns it when the run ends with it.
Result<void> FrameLoop::fail(FrameRecord& frame, Error error, bool pre_roll) {
  frame.state = FrameRecord::State::failed;
  frame.error = error;
  if (pre_roll && !ends_run(error)) {
    console_.diagnostics().warn("left out of the pre-roll: " + error.text());
    return {};
  }
  if (total_ == 1 || options_.fail_fast || ends_run(error)) return error;
  ++failed_;
  console_.error(error);
  return {};
}

}  // namespace afterglow
