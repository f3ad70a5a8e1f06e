// SPDX-License-Identifier: MIT
#include "batch/batch_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "batch/movie_times.h"
#include "batch/resume.h"
#include "batch/schedule.h"
#include "batch/watch_run.h"
#include "core/file.h"
#include "core/file_record.h"
#include "core/stopwatch.h"
#include "core/temporary.h"
#include "core/text.h"
#include "graph/history.h"
#include "image/video_writer.h"

namespace afterglow {
namespace {

constexpr int kFramesInFlight = 3;  // of a sequence: while one runs the next is packed and the last is unpacked

/// What outlives a step.
struct BatchRun {
  const BatchRequest& request;
  const RunEvents& events;
  RunReport& report;
  Clock::time_point start = Clock::now();
  std::unique_ptr<FrameSink> sink{};
  std::unique_ptr<Session> session{};
  FrameList list{};
  std::optional<PictureHeader> first{};  ///< of the first picture that can be read; none: nothing has to be known of it
  std::optional<FrameNotes> notes{};
  std::optional<Lock> lock{};  ///< of what runs, when one is to be written or held against

  double milliseconds() const { return milliseconds_since(start); }
};

std::string options_text(const PixelOptions& options) {
  std::string text;
  for (const auto& [name, value] : options) text += name + "=" + value + "|";
  return text;
}

/// What light the entries get and make in the frame that was evaluated last: warns of those that get other light than
/// they are made for.
Result<void> follow_light(BatchRun& run, const Build& build, FrameLoop& loop) {
  AFTERGLOW_TRY(const auto spaces, run.session->preset().spaces());
  if (ends_in_view(spaces)) {
    loop.show_view();
    if (const OutputSpace* space = run.request.loop.write.space)
      run.events.diagnostics.warn(
          fmt::format("--output-space {} encodes what are codes of a display already; without it "
                      "outputs hold the codes as they are",
                      space->name()));
  }
  for (std::size_t i = 0; i < spaces.size(); ++i) {
    if (spaces[i].warning.empty()) continue;
    const StackEntry& entry = (*build.entries)[i];
    run.events.diagnostics.warn(fmt::format("{}:{}: {}", entry.file, entry.line, spaces[i].warning));
  }
  return {};
}

/// How many earlier frames the frames of this run need; empty when none depends on another. Where settings change from
/// frame to frame all are asked, if effects may look back at all: one may be active in a frame alone.
Result<std::optional<int>> pre_roll_of(BatchRun& run, FrameLoop& loop) {
  const auto& frames = run.report.frames;
  Preset& preset = run.session->preset();
  constexpr std::size_t kSome = 64;
  const std::size_t several = preset.may_look_back() ? frames.size() : std::min(frames.size(), kSome);
  const std::size_t asked = preset.may_change() ? several : 1;
  std::optional<int> most;
  const Size size = run.first ? loop.size_of(*run.first) : kUsualSize;
  for (std::size_t i = 0; i < asked; ++i) {
    const double frame = frames[i * frames.size() / asked].job.frame;
    const BuildContext context = usual_context(preset, size, frame, run.request.loop.fps);
    // A picture alone is asked itself, and what is said of it is what runs.
    auto build = frames.size() == 1 ? loop.inspect(frames.front().job) : run.session->evaluate(context);
    if (!build && frames.size() == 1 && build.error().kind == ErrorKind::io) build = run.session->evaluate(context);
    if (!build) return std::move(build).error();
    if (i == 0) AFTERGLOW_CHECK(follow_light(run, **build, loop));
    const Graph& graph = (*build)->graph;
    if (!graph.histories.empty()) most = std::max(most.value_or(0), run.request.pre_roll.value_or(pre_roll(graph)));
  }
  return most;
}

std::vector<const FrameJob*> jobs_of(const FrameRecords& frames, std::size_t most) {
  std::vector<const FrameJob*> jobs;
  for (std::size_t i = 0; i < std::min(most, frames.size()); ++i) jobs.push_back(&frames[i].job);
  return jobs;
}

/// What the look is made of in these frames.
Result<Inventory> inventory_of(BatchRun& run, std::size_t frames) {
  const auto jobs = jobs_of(run.report.frames, frames);
  Preset& preset = run.session->preset();
  return take_inventory(preset, usual_contexts(preset, jobs, run.request.loop.fps, run.first), run.events.diagnostics);
}

bool takes_notes(const BatchRun& run) {
  return !run.sink->is_one() && (run.request.resume || run.report.frames.size() > 1);
}

/// What frames are noted to be made of, and for `resume` those that need not be made.
Result<void> prepare_notes(BatchRun& run) {
  const BatchRequest& asked = run.request;
  if (!takes_notes(run)) return {};
  AFTERGLOW_TRY(const Inventory inventory, inventory_of(run, 1));
  Preset& preset = run.session->preset();
  AFTERGLOW_TRY(const Hash look, look_hash(preset, inventory, options_text(asked.pixel_options)));
  run.notes.emplace(look, preset);
  if (!asked.resume) return {};
  run.notes->made_by(execution_name(run.session->stack().choice().execution));
  if (const int left = remove_leftovers(run.report.frames))
    run.events.note(fmt::format("removed {} half-written files of runs that were killed", left));
  for (auto& frame : run.report.frames)
    if (run.notes->is_up_to_date(frame.job)) {
      frame.state = FrameRecord::State::up_to_date;
      run.events.note(fmt::format("{} is up to date", frame.job.output.string()));
    }
  return {};
}

/// Ends the run when the look is not that of `locked`; keeps what to write into `lock` when the run is done.
Result<void> prepare_lock(BatchRun& run) {
  const BatchRequest& asked = run.request;
  if (asked.lock.empty() && asked.locked.empty()) return {};
  AFTERGLOW_TRY(const Inventory inventory, inventory_of(run, run.report.frames.size()));
  AFTERGLOW_TRY(run.lock, lock_of(*run.session, inventory, asked.pixel_options));
  if (asked.locked.empty()) return {};
  AFTERGLOW_TRY(const Lock locked, read_lock(asked.locked));
  return hold_against(locked, *run.lock, asked.locked, run.events.diagnostics);
}

/// Outputs that cannot be written are refused before any work.
Result<void> check_outputs(const BatchRun& run) {
  std::vector<std::filesystem::path> outputs;
  for (const auto& frame : run.report.frames) outputs.push_back(frame.job.output);
  return check_pictures(outputs, run.request.files, run.request.loop.write);
}

/// So are those in whose place something lies that is not to be replaced: by now the look has said what it reads. What
/// `resume` keeps may be read-only.
Result<void> check_places(const BatchRun& run) {
  FilesOfFrames files;
  for (const auto& frame : run.report.frames) {
    if (frame.state == FrameRecord::State::waiting && !run.sink->is_one())
      AFTERGLOW_CHECK(check_replaceable(frame.job.output));
    files.add(frame.job);
  }
  files.read.clear();
  auto good = check_written(run.request, std::move(files), looked_at(*run.session->preset().probes()));
  run.report.replaces_nothing = static_cast<bool>(good);
  return good;
}

/// The next frame of standard input.
Result<FrameRecord*> next_record(BatchRun& run) {
  AFTERGLOW_TRY(std::optional<FrameJob> job, run.list.more());
  if (!job) return static_cast<FrameRecord*>(nullptr);
  run.report.frames.push_back({.job = std::move(*job)});
  return &run.report.frames.back();
}

Result<void> run_frames(BatchRun& run) {
  const BatchRequest& asked = run.request;
  auto& frames = run.report.frames;
  if (asked.resume && is_one_output(asked.files.output))
    return Error{ErrorKind::usage, "--resume goes on with files of their own; a video or a stream is made whole", "", 0,
                 "a pattern like out.####.exr, which becomes a video afterwards"};
  const FrameJob* last = frames.empty() ? nullptr : &frames.back().job;
  AFTERGLOW_TRY(run.sink, open_sink(asked.files, asked.loop, frames.size(), last, run.events.diagnostics));
  if (!run.sink->is_one()) AFTERGLOW_CHECK(check_outputs(run));
  if (run.sink->is_one() && asked.watch)
    return Error{ErrorKind::usage, "--watch makes frames in the order in which they come; one file cannot take them",
                 "", 0, "pictures, like out.####.exr"};
  if (run.list.more && asked.watch)
    return Error{ErrorKind::usage, "--watch is for files; frames on standard input are run as they come"};
  SessionOptions opened = asked.session;
  opened.frames = frames.size() > 1 || run.list.more ? kFramesInFlight : 1;
  const double before = run.milliseconds();
  AFTERGLOW_TRY(run.session, Session::begin(asked.preset, opened, run.events.diagnostics));
  // Others read their first pictures while it opens.
  const bool asks_device = asked.resume || asked.watch || !asked.lock.empty() || !asked.locked.empty();
  if (asks_device) AFTERGLOW_CHECK(run.session->ready());
  if (asks_device || opened.frames > 1) run.first = first_header(jobs_of(frames, frames.size()), asked.loop.read);
  FrameLoopOptions options = asked.loop;
  options.read.input_space = asked.input_space.empty() ? run.session->preset().input_space() : asked.input_space;
  if (!options.read.keep_negative) options.read.keep_negative = run.session->preset().keeps_negative();
  AFTERGLOW_CHECK(prepare_lock(run));
  RunEvents events = run.events;
  if (asked.watch) events.failed = [](const Error&) {};  // the watch tells, when it has tried again
  FrameLoop loop(*run.session, *run.sink, options, events);
  if (run.first && frames.size() > 1)
    if (auto good = loop.check_region(*run.first); !good) return named(std::move(good).error(), frames.front().job);
  AFTERGLOW_TRY(const std::optional<int> earlier, pre_roll_of(run, loop));
  if (earlier) loop.follow_histories(*earlier);
  if (earlier && takes_notes(run)) note_earlier_files(frames, asked.files, *earlier);
  AFTERGLOW_CHECK(prepare_notes(run));
  AFTERGLOW_CHECK(check_places(run));
  if (run.notes) loop.note_frames(*run.notes);
  if (!run.list.more) loop.know_frames(frames);
  const auto run_waiting = [&]() -> Result<void> {
    Schedule schedule =
        earlier ? schedule_with_histories(frames, asked.files, *earlier, options.cuts) : plain_schedule(frames);
    if (run.list.more) schedule.more = [&run] { return next_record(run); };
    run.report.pre_roll += schedule.earlier.size();
    const auto begun = Clock::now();
    const double used = processor_milliseconds();
    auto done = loop.run(schedule);
    run.report.frames_wall += milliseconds_since(begun);
    run.report.processors += processor_milliseconds() - used;
    return done;
  };
  run.report.startup = std::max(0.0, run.milliseconds() - run.session->stack().script_milliseconds());
  auto done = asked.watch ? run_watching(frames, earlier.value_or(0), options.fail_fast, run.events, run_waiting)
                          : run_waiting();
  if (run.session->ready())
    run.report.startup = std::max(run.report.startup, before + run.session->report().times.device);
  run.report.memory_needed = loop.largest_need();
  return done;
}

}  // namespace

void FilesOfFrames::add(const FrameJob& frame) {
  if (outputs.empty() || outputs.back() != frame.output) outputs.push_back(frame.output);
  std::vector<std::filesystem::path> sources = frame.sources();
  for (std::size_t i = 0; i < sources.size(); ++i)
    if (i >= last_.size() || last_[i] != sources[i]) read.push_back(sources[i]);
  last_ = std::move(sources);
}

Result<void> check_written(const BatchRequest& request, FilesOfFrames frames,
                           const std::vector<std::filesystem::path>& look) {
  auto& read = frames.read;
  read.insert(read.end(), look.begin(), look.end());
  read.insert(read.end(),
              {request.preset, request.locked, request.session.stack.calibration, request.loop.write.video.audio});
  return check_written(request.beside, frames.outputs, read, new_folder(request.files.output));
}

bool take_fps(BatchRequest& request, const std::vector<FrameJob>& frames) {
  FrameLoopOptions& loop = request.loop;
  if (!std::exchange(loop.takes_fps, false) || !is_one_output(request.files.output)) return false;
  if (frames.empty() || frames.front().movie) return false;
  std::vector<const FrameJob*> jobs;
  for (const FrameJob& job : frames) jobs.push_back(&job);
  const auto header = first_header(jobs, loop.read);
  if (!header) return false;  // told where they are read
  const double said = said_fps(*header->facts);
  if (said <= 0) return false;
  loop.fps = said;
  for (auto& [name, value] : request.pixel_options)
    if (name == "--fps") value = number_text(loop.fps);
  return true;
}

namespace {

Result<void> run_named(const BatchRequest& asked, const RunEvents& events, RunReport& report) {
  BatchRequest request = asked;
  BatchRun run{request, events, report};
  AFTERGLOW_CHECK(check_written(request, {}, {}));  // a report of frames that cannot be listed is written, too
  report.replaces_nothing = true;
  AFTERGLOW_TRY(run.list, list_frames(request.files, events.diagnostics));
  if (!request.loop.takes_fps) tell_of_own_times(request.loop.fps, run.list.jobs, events.diagnostics);
  tell_of_lost_times(request.files.output, run.list.jobs, events.diagnostics);
  if (take_fps(request, run.list.jobs))
    events.note(fmt::format("{}: {} frames a second, as the first picture says", request.files.output,
                            number_text(request.loop.fps)));
  if (run.list.more && request.resume)
    return Error{ErrorKind::usage, "--resume needs inputs that are files, not standard input"};
  FilesOfFrames files;
  for (const auto& job : run.list.jobs) {
    files.add(job);
    report.frames.push_back({.job = job});
  }
  run.list.jobs.clear();
  auto good = check_written(request, std::move(files), {});
  report.replaces_nothing = static_cast<bool>(good);
  AFTERGLOW_CHECK(std::move(good));
  auto done = run_frames(run);
  if (done && !request.lock.empty()) done = write_file_atomically(request.lock, lock_text(*run.lock));
  if (run.session && run.session->ready()) report.session = run.session->report();
  report.wall = run.milliseconds();
  return done;
}

/// What came on standard input lies in memory, under a name that nobody gave.
std::string with_given_names(std::string text) {
  constexpr std::string_view kInMemory = "/proc/self/fd/";
  for (std::size_t at = 0; (at = text.find(kInMemory, at)) != std::string::npos; ++at) {
    const std::size_t end = std::min(text.find_first_not_of("0123456789", at + kInMemory.size()), text.size());
    text.replace(at, end - at, "-");
  }
  return text;
}

Error with_given_names(Error error) {
  error.file = with_given_names(std::move(error.file));
  error.message = with_given_names(std::move(error.message));
  return error;
}

/// `run_named`, whose messages call that input "-".
Result<void> run_standard_input(const BatchRequest& asked, const RunEvents& events, RunReport& report) {
  Diagnostics diagnostics([&](Severity severity, const std::string& text) {
    const std::string named = with_given_names(text);
    if (severity == Severity::warning) events.diagnostics.warn(named);
    if (severity == Severity::printed) events.diagnostics.print(named);
    if (severity == Severity::note) events.diagnostics.note(named);
  });
  RunEvents own{.diagnostics = diagnostics,
                .progress = events.progress,
                .end_progress = events.end_progress,
                .failed = [&](const Error& error) { events.failed(with_given_names(error)); },
                .note = events.note,
                .interrupted = events.interrupted};
  auto done = run_named(asked, own, report);
  for (FrameRecord& frame : report.frames) {
    frame.job.input = with_given_names(frame.job.input.string());
    if (frame.error) frame.error = with_given_names(*frame.error);
  }
  return done ? std::move(done) : with_given_names(done.error());
}

}  // namespace

Result<void> run_batch(const BatchRequest& asked, const RunEvents& events, RunReport& report) {
  const bool standard = std::ranges::find(asked.files.inputs, "-") != asked.files.inputs.end();
  return standard ? run_standard_input(asked, events, report) : run_named(asked, events, report);
}

}  // namespace afterglow
