// SPDX-License-Identifier: MIT
#include "batch/frame_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <thread>
#include <utility>

#include "batch/crop.h"
#include "core/beside.h"
#include "core/file.h"
#include "core/file_time.h"
#include "core/release_memory.h"
#include "core/stopwatch.h"
#include "core/text.h"
#include "image/scale.h"
#include "image/sequence.h"

namespace afterglow {
namespace {

/// A file that fails spoils its frame; a script, a device or an option that fails would spoil them all.
bool ends_run(const Error& error) { return error.kind != ErrorKind::io && error.kind != ErrorKind::other; }

Error interruption() { return {ErrorKind::interrupted, "interrupted"}; }

}  // namespace

struct FrameLoop::Reading {
  FrameRecord* frame = nullptr;
  std::size_t index = 0;  ///< among the frames that are written
  bool pre_roll = false, restart = false;
  bool told_later = false;       ///< why it is refused
  ShotSketch sketch;             ///< where cuts are looked for
  std::optional<Error> refused;  ///< by the header; nothing was read
  std::optional<Scaling> scaling;
  Hash inputs{};           ///< FrameNotes::inputs_of, before any of them was read
  FrameRequest request{};  ///< its region: of the picture, when a part of the display window is wanted
  ReadOptions options;
  std::future<Result<Picture>> picture;
};

FrameLoop::FrameLoop(Session& session, FrameSink& sink, FrameLoopOptions options, RunEvents events)
    : session_(session),
      sink_(sink),
      options_(std::move(options)),
      events_(std::move(events)),
      planner_(session, sink, options_),
      writing_(sink, memory_),
      sequences_(events_.diagnostics) {}

FrameLoop::~FrameLoop() = default;

void FrameLoop::know_frames(const FrameRecords& frames) {
  sequences_.know(frames, [this](const FrameJob& job) {
    const auto header = read_header(job.input, planner_.read_options(job));
    return header ? header->auxiliary : std::vector<std::string>();
  });
}

Result<void> FrameLoop::run(Schedule& schedule) {
  const auto& frames = schedule.frames;
  schedule_ = &schedule;
  full_ = false;
  done_ = failed_ = 0;
  non_finite_ = {};
  replaced_.clear();
  pre_roll_ = schedule.earlier.size();
  total_ = frames.size() - pre_roll_;
  places_ = frames.empty() ? 0 : frames.back().index + 1;
  endless_ = static_cast<bool>(schedule.more);
  const auto start = Clock::now();
  std::deque<std::unique_ptr<Reading>> next;
  std::size_t begun = 0;
  for (std::size_t i = 0; i < frames.size() || fetch(schedule, i); ++i) {
    if (events_.interrupted()) return close(interruption());
    if (frames.size() > 1)
      events_.progress(i, frames.size(),
                       frames[i].pre_roll ? "before " + frames[i].record->job.output.filename().string()
                                          : frames[i].record->job.output.filename().string(),
                       milliseconds_since(start) / 1000);
    if (next.empty()) next.push_back(begin_reading(frames[begun++]));
    auto reading = std::move(next.front());
    next.pop_front();
    // The device opens, and shaders, pipelines and memory are made, while the first pictures are read.
    if (i == 0) {
      if (!endless_ && overlap_.read > 1) begin_further(schedule, next, begun, overlap_.read - 1);
      session_.begin_opening();
      if (auto ready = session_.ready(); !ready) return close(std::move(ready));
      if (notes_) notes_->made_by(execution_name(session_.stack().choice().execution));
      auto prepared = reading->refused ? Result<void>() : session_.prepare(reading->request);
      if (!prepared && ends_run(prepared.error())) return close(fail(*reading->frame, std::move(prepared).error()));
    }
    if (reading->picture.valid()) {
      const auto waiting = Clock::now();
      reading->picture.wait();
      reading->frame->steps.waited_read = milliseconds_since(waiting);
    }
    begin_further(schedule, next, begun, overlap_.read);
    if (auto done = process(std::move(reading)); !done) return close(done.error());
    if (!overlap_)
      if (auto done = finish_writing(0); !done) return close(done.error());
  }
  return close({});
}

/// Begins to read further ones, until `next` has `most`; `begun`: how many have begun so far.
void FrameLoop::begin_further(Schedule& schedule, std::deque<std::unique_ptr<Reading>>& next, std::size_t& begun,
                              std::size_t most) {
  while (next.size() < most && (begun < schedule.frames.size() || fetch(schedule, begun)))
    next.push_back(begin_reading(schedule.frames[begun++]));
}

/// Frames of a stream come one by one. False: there is none of that place.
bool FrameLoop::fetch(Schedule& schedule, std::size_t place) {
  if (!schedule.more || place != schedule.frames.size()) return false;
  auto record = schedule.more();
  if (!record) stream_error_ = std::move(record).error();
  if (!record || !*record) {
    schedule.more = {};
    return false;
  }
  schedule.frames.push_back({*record, false, false, place - pre_roll_});
  places_ = total_ = schedule.frames.size() - pre_roll_;
  return true;
}

/// What was written appears when the run has come to its end, failed frames or not; of an interrupted one if that is
/// wished.
Result<void> FrameLoop::finish_sink(const Result<void>& result) {
  const bool keeps = !result && result.error().kind == ErrorKind::interrupted && options_.keep_partial;
  return result || keeps ? sink_.finish(keeps ? 0 : places_) : Result<void>();
}

/// Waits for the last output and sums up.
Result<void> FrameLoop::close(Result<void> result) {
  // Waiting for a stream's next frame was given up: what came before it is no whole run.
  if (result && stream_error_ && stream_error_->kind == ErrorKind::interrupted) result = *stream_error_;
  while (result && !running_.empty()) result = finish_running();
  running_.clear();
  auto last = finish_writing(0);
  if (last) last = finish_sink(result);
  events_.end_progress();
  if (result || result.error().kind == ErrorKind::interrupted) sequences_.sum_up(events_, static_cast<bool>(result));
  if (full_) return full();
  if (!result) {
    if (result.error().kind == ErrorKind::interrupted && total_ > 1) {
      Error error = result.error();
      error.message = fmt::format("interrupted after {} of {} frames{}", done_, total_,
                                  sink_.is_one() || endless_ ? "" : "; --resume goes on from there");
      return error;
    }
    return result;
  }
  if (!last) return last;
  if (stream_error_) return *stream_error_;
  if (total_ > 1) non_finite_.sum_up(events_.diagnostics);
  for (const auto& [name, frames] : replaced_)
    events_.diagnostics.warn(
        fmt::format("history '{}' began anew {} within a sequence: passes that it is made of, or its size, were "
                    "others than in the frame before",
                    name, frames == 1 ? "once" : fmt::format("{} times", frames)));
  if (failed_ > 0) return Error{ErrorKind::io, fmt::format("{} of {} frames failed", failed_, total_)};
  return {};
}

/// Where nobody tells where they are.
bool FrameLoop::looks_for_cuts(const FrameJob& job) const {
  return options_.histories && options_.cuts.looks(job.movie != nullptr);
}

/// Whether it is of another shot than the frame that was made last.
bool FrameLoop::begins_shot(const Reading& reading) const {
  if (!options_.histories || !last_) return false;
  const FrameJob& job = reading.frame->job;
  if (options_.cuts.between(*last_, job.frame)) return true;
  if (!looks_for_cuts(job) || reading.sketch.blank) return false;
  // What lies further back than the pre-roll must not count: a part of the sequence would not know of it.
  const bool forgotten = blank_frames_ > 0 && blank_frames_ >= pre_roll_frames_;
  return last_sketch_.blank || forgotten || !same_shot(last_sketch_, reading.sketch);
}

/// The next frame follows none.
void FrameLoop::begin_shot() {
  last_.reset();
  last_sketch_ = {};
  blank_frames_ = 0;
}

/// What there was no room for.
Error FrameLoop::full() const {
  std::vector<int> left;
  for (const ScheduledFrame& one : schedule_->frames)
    if (!one.pre_roll && one.record->state != FrameRecord::State::done) left.push_back(one.record->job.frame);
  std::ranges::sort(left);
  const bool numbers = std::ranges::adjacent_find(left) == left.end();
  return {ErrorKind::io, fmt::format("the disk is full: {} of {} frames were made{}{}", done_, total_,
                                     numbers && !left.empty() ? "; not made: " + frames_text(left) : "",
                                     endless_ ? "" : "; --resume goes on from there")};
}

/// Which frame this one follows: the last of its sequence that was made. It was evaluated as if none failed.
Result<void> FrameLoop::place_in_time(Reading& reading) {
  if (!options_.histories) return {};
  reading.request.restart = !last_;
  reading.request.step = last_ ? reading.frame->job.frame - *last_ : 1;
  if (reading.request.step == reading.request.build->context.step) return {};
  BuildContext context = reading.request.build->context;
  context.step = reading.request.step;
  context.restart = reading.request.restart;
  AFTERGLOW_TRY(reading.request.build, session_.evaluate(context));
  return {};
}

/// A frame that failed is missing in the history of those behind it; one whose output failed is not.
void FrameLoop::note_gap(const FrameJob& job) {
  if (options_.histories && job.earlier.of && (!last_ || *last_ < job.frame))
    gaps_.push_back(job.earlier.of->begin_of(job.frame));
}

bool FrameLoop::has_gap(const FrameJob& job) const {
  return std::ranges::any_of(gaps_,
                             [&](std::size_t place) { return place >= job.earlier.begin && place < job.earlier.end; });
}

Result<std::shared_ptr<const Build>> FrameLoop::inspect(const FrameJob& job) {
  AFTERGLOW_TRY(PlannedFrame planned, planner_.plan(job, 1, true));
  planned.job = &job;
  planned_ = std::move(planned);
  return planned_->request.build;
}

/// Whether there is anything to do for the device; what a picture's content makes needless is not known yet.
bool FrameLoop::runs(const Reading& reading) { return !reading.request.build->graph.passes.empty(); }

/// Pictures that only become codes, or nothing else at all, need not be floats in between. A result in full floats
/// takes the source's place.
bool FrameLoop::halves_suffice(const Reading& reading) const {
  return options_.nan_policy == NanPolicy::zero && !reading.scaling && !reading.request.region &&
         (reading.request.encoding || !runs(reading));
}

std::unique_ptr<FrameLoop::Reading> FrameLoop::begin_reading(const ScheduledFrame& scheduled) {
  auto reading = std::make_unique<Reading>();
  FrameRecord& frame = *scheduled.record;
  reading->frame = &frame;
  reading->index = scheduled.index;
  reading->pre_roll = scheduled.pre_roll;
  reading->restart = scheduled.restart;
  if (scheduled.restart) begun_.reset();
  const bool follows = options_.histories && begun_;
  const double step = follows ? frame.job.frame - *begun_ : 1;
  const auto planning = Clock::now();
  if (notes_) reading->inputs = notes_->inputs_of(frame.job);
  const bool known = planned_ && planned_->job == &frame.job && step == 1;
  auto planned = known ? Result<PlannedFrame>(*std::exchange(planned_, std::nullopt))
                       : planner_.plan(frame.job, step, options_.histories && !begun_);
  frame.steps.plan = milliseconds_since(planning);
  if (!planned) {
    reading->refused = std::move(planned).error();
    return reading;
  }
  begun_ = frame.job.frame;
  reading->options = planner_.read_options(frame.job);
  reading->options.memory = &memory_;
  reading->scaling = planner_.scaling_of(planned->header);
  planner_.tell_of_shape(planned->header, frame.job, events_.diagnostics);
  reading->request = std::move(planned->request);
  if (auto lacking = sequences_.add(frame, planned->header, reading->options.auxiliary, *reading->request.build)) {
    reading->refused = std::move(*lacking);
    reading->told_later = true;
    return reading;
  }
  const auto need = planner_.need_of(planned->header, *reading->request.build, frame.job);
  if (!need) {
    reading->refused = need.error();
    return reading;
  }
  overlap_ = several() ? overlap_of(*need, options_.max_memory, std::thread::hardware_concurrency(),
                                    endless_ || frame.job.movie)
                       : Overlap{};
  reading->options.halves = halves_suffice(*reading);
  const bool reuse = options_.reuse && several() && runs(*reading);
  ShotSketch* const sketch = looks_for_cuts(frame.job) ? &reading->sketch : nullptr;
  reading->picture = beside([this, &frame, reuse, sketch, options = reading->options, scaling = reading->scaling,
                             header = std::move(planned->header)]() -> Result<Picture> {
    const auto start = Clock::now();
    const double files = FileTime::of_thread();
    auto picture = read_picture(header, options, events_.diagnostics);
    if (picture && scaling) scale_picture(*picture, *scaling);
    if (picture && reuse) note_content(*picture);
    if (picture && sketch) *sketch = sketch_of(*picture);
    frame.steps.read = milliseconds_since(start);
    frame.steps.decode = std::max(0.0, frame.steps.read - (FileTime::of_thread() - files));
    return picture;
  });
  return reading;
}

/// Frames in flight beside the one that is submitted. One that a trace may have to make again, with what the frame
/// before handed on, is waited for at once.
std::size_t FrameLoop::ahead() const {
  const bool may = overlap_ && !options_.histories && options_.nan_policy != NanPolicy::fail;
  return may ? static_cast<std::size_t>(session_.frames() - 1) : 0;
}

/// From the picture that has been read to one that is in flight, and the oldest of those to one that is being written.
Result<void> FrameLoop::process(std::unique_ptr<Reading> reading) {
  FrameRecord& frame = *reading->frame;
  if (reading->restart) {
    begin_shot();
    gaps_.clear();
  }
  if (reading->refused) return fail(frame, *reading->refused, reading->pre_roll, reading->told_later);
  auto picture = reading->picture.get();
  if (!picture) return fail(frame, named(std::move(picture).error(), frame.job), reading->pre_roll);
  frame.begins_shot = begins_shot(*reading);
  if (frame.begins_shot) {
    begin_shot();
    events_.note(fmt::format("frame {} begins a shot: effects that look back begin anew", frame.job.frame));
  }
  if (auto placed = place_in_time(*reading); !placed)
    return fail(frame, named(std::move(placed).error(), frame.job), reading->pre_roll);
  if (events_.interrupted()) return interruption();
  // What another run would make of the same files is not this.
  if (notes_ && !has_gap(frame.job)) frame.job.made_of = notes_->text(reading->inputs, reading->request.build->depends);
  frame.size = picture->color.size();
  frame.non_finite.input = picture->non_finite;
  if (const auto begun = begin(*reading, std::move(*picture)); !begun) return failed(*reading, begun.error());
  running_.push_back(std::move(reading));
  while (running_.size() > ahead()) AFTERGLOW_CHECK(finish_running());
  return {};
}

/// Validation goes first: it says what a failure comes from.
Result<void> FrameLoop::failed(const Reading& reading, Error error) {
  if (session_.device().validation_errors() > 0)
    return fail(*reading.frame,
                {ErrorKind::device, "Vulkan validation: " + session_.device().validation_messages().front()});
  return fail(*reading.frame, named(std::move(error), reading.frame->job), reading.pre_roll);
}

Result<void> FrameLoop::begin(Reading& reading, Picture picture) {
  if (options_.nan_policy == NanPolicy::fail) {
    AFTERGLOW_TRY(const Trace trace, session_.trace(picture, reading.request, options_.nan_policy));
    take_findings(reading.frame->non_finite, trace, picture);
    if (!trace.passes.empty())
      return non_finite_error(reading.frame->non_finite.passes.front(), reading.frame->job.input);
  }
  return session_.submit(std::move(picture), reading.request);
}

/// The oldest frame in flight, until it is being written.
Result<void> FrameLoop::finish_running() {
  const auto reading = std::move(running_.front());
  running_.pop_front();
  FrameRecord& frame = *reading->frame;
  Picture picture;
  if (const auto made = make(*reading, picture); !made) return failed(*reading, made.error());
  if (session_.device().validation_errors() > 0) return failed(*reading, {});
  const auto replaced = session_.take_replaced_histories();
  if (options_.histories && last_ && !reading->request.restart)
    for (const auto& name : replaced) ++replaced_[name];
  last_ = frame.job.frame;
  blank_frames_ = reading->sketch.blank ? blank_frames_ + 1 : 0;
  if (!reading->sketch.blank) last_sketch_ = std::move(reading->sketch);
  if (reading->pre_roll) {
    frame.state = FrameRecord::State::done;
    return {};
  }
  const SessionReport report = session_.report();
  frame.times = report.times.frame;
  non_finite_.add(frame.non_finite);
  frame.skipped = share_skips(report.skipped_now);
  if (report.clamped > 0)
    events_.diagnostics.warn_once("clamped", fmt::format("{}: {} samples were held at ±65504, the largest half float",
                                                         frame.job.input.string(), report.clamped));
  const int finer = reading->scaling ? reading->scaling->finer : 1;
  shrink_picture(picture, finer);
  frame.size = {frame.size.width / finer, frame.size.height / finer};  // as it is delivered
  if (const auto& part = reading->request.region)
    crop_picture(picture, *options_.region,
                 {part->x / finer, part->y / finer, part->width / finer, part->height / finer});
  if (auto taken = sink_.takes(frame.job, picture); !taken) return fail(frame, std::move(taken).error());
  if (events_.interrupted()) return interruption();
  const auto waiting = Clock::now();
  AFTERGLOW_CHECK(finish_writing(std::max<std::size_t>(overlap_.written, 1) - 1));
  frame.steps.waited_write = milliseconds_since(waiting);
  picture.view = options_.view;
  writing_.add(frame, reading->index, std::move(picture));
  return {};
}

/// The list of one of the last frames, where it says the same.
SharedSkips FrameLoop::share_skips(const std::vector<Skipped>& skips) {
  constexpr std::size_t kMostLists = 8;
  if (skips.empty()) return nullptr;
  for (const SharedSkips& known : skips_)
    if (*known == skips) return known;
  skips_.push_front(std::make_shared<const std::vector<Skipped>>(skips));
  if (skips_.size() > kMostLists) skips_.pop_back();
  return skips_.front();
}

/// The frame's result. One in which something was not finite, or more than half floats hold, is made once more from its
/// file, pass by pass in full floats and mended.
Result<void> FrameLoop::make(Reading& reading, Picture& picture) {
  picture.unorm8 = memory_.take_codes();
  AFTERGLOW_CHECK(session_.collect(picture));
  const SessionReport report = session_.report();
  if (!report.flagged && report.clamped == 0) return {};
  return mend(reading, picture);
}

/// Traces the frame from its file: its source is gone, the result took its place.
Result<Trace> FrameLoop::trace_again(const Reading& reading) {
  Diagnostics quiet;  // reading has said all there is to say
  ReadOptions options = reading.options;
  options.halves = false;
  AFTERGLOW_TRY(Picture source, read_picture(reading.frame->job.input, options, quiet));
  if (reading.scaling) scale_picture(source, *reading.scaling);
  return session_.trace(source, reading.request, options_.nan_policy);
}

Result<void> FrameLoop::mend(Reading& reading, Picture& picture) {
  FrameRecord& frame = *reading.frame;
  const bool flagged = session_.report().flagged;
  auto traced = trace_again(reading);
  if (!traced && !flagged) return {};  // as near as half floats get
  if (!traced) {
    Error error = std::move(traced).error();
    error.message = "values that are not finite came up; the frame could not be made pass by pass: " + error.message;
    return error;
  }
  Trace trace = std::move(traced).value();
  session_.forget_clamped();
  take_findings(frame.non_finite, trace, picture);
  frame.non_finite.untraced = flagged && trace.passes.empty() && trace.overflows.empty();
  non_finite_.tell_overflows(frame.non_finite, frame.job.input, events_.diagnostics);
  non_finite_.tell(frame.non_finite, frame.job.input, options_.nan_policy, events_.diagnostics);
  if (options_.nan_policy == NanPolicy::fail && (frame.non_finite.untraced || !trace.passes.empty()))
    return Error{ErrorKind::script, kUntraced};
  picture.color = std::move(trace.result);
  picture.halves.clear();
  picture.unorm8.clear();
  return {};
}

/// Waits until no more than `left` frames are being written.
Result<void> FrameLoop::finish_writing(std::size_t left) {
  while (writing_.size() > left) {
    auto [frame, written] = *writing_.take();
    release_memory(frame->job.made_of);  // noted, and sequences are long
    if (!written && sink_.is_one()) return written;
    if (!written && full_ && is_disk_full(written.error())) {  // told already
      frame->state = FrameRecord::State::failed;
      frame->error = written.error();
      continue;
    }
    if (!written) {
      const Error error = written.error();
      AFTERGLOW_CHECK(fail(*frame, error));
      if (is_disk_full(error)) full_ = true;
      continue;
    }
    frame->state = FrameRecord::State::done;
    if (frame->job.passing) frame->job.movie.reset();
    ++done_;
  }
  return full_ ? full() : Result<void>();
}

/// Notes the failure; returns it when the run ends with it.
Result<void> FrameLoop::fail(FrameRecord& frame, Error error, bool pre_roll, bool told_later) {
  frame.state = FrameRecord::State::failed;
  note_gap(frame.job);
  if (frame.job.passing) frame.job.movie.reset();
  frame.error = error;
  if (pre_roll && options_.whole_pre_roll) return error;
  if (pre_roll && !ends_run(error)) {
    events_.diagnostics.warn("left out of the pre-roll: " + error.text());
    return {};
  }
  if ((total_ == 1 && !endless_) || options_.fail_fast || ends_run(error)) return error;
  ++failed_;
  if (!told_later) events_.failed(error);
  return {};
}

}  // namespace afterglow
