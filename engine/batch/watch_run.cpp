// SPDX-License-Identifier: MIT
#include "batch/watch_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

#include "core/file.h"
#include "core/whole_files.h"

namespace afterglow {
namespace {

using State = FrameRecord::State;

/// A frame that is waited for.
struct Watched {
  FrameRecord* record = nullptr;
  std::size_t first = 0;          ///< of the frames that reach its pixels: from there to before this one
  std::optional<Hash> now, made;  ///< its files as they are, and as they were when it was made last
  bool due = true;                ///< it is to be made
  bool doubted = false;           ///< it failed, and is tried once more before that is told: it may be half written
};

/// By number within each sequence.
std::vector<Watched> watched_frames(FrameRecords& frames, int earlier) {
  std::vector<Watched> out;
  for (auto& frame : frames) out.push_back({.record = &frame, .due = frame.state == State::waiting});
  std::ranges::stable_sort(
      out, {}, [](const Watched& one) { return std::tie(one.record->job.sequence, one.record->job.frame); });
  std::size_t begin = 0;  // of the sequence
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (out[i].record->job.sequence != out[begin].record->job.sequence) begin = i;
    out[i].first = i - std::min(i - begin, static_cast<std::size_t>(earlier));
  }
  return out;
}

WholeFiles watch_inputs(const FrameRecords& frames) {
  std::set<std::filesystem::path> folders;
  for (const auto& frame : frames)
    for (const auto& file : frame.job.sources()) folders.insert(file.parent_path());
  return WholeFiles(folders);
}

/// How many there are among the first frames, for any number of these: between two places lies the difference.
template <class Is>
std::vector<std::size_t> counts(const std::vector<Watched>& frames, const Is& is) {
  std::vector<std::size_t> out(frames.size() + 1);
  for (std::size_t i = 0; i < frames.size(); ++i) out[i + 1] = out[i] + (is(frames[i]) ? 1 : 0);
  return out;
}

bool grows(const Watched& one, WholeFiles& watch) {
  return std::ranges::any_of(one.record->job.sources(), [&](const auto& file) { return watch.may_grow(file); });
}

/// Looks at all files once more; what has changed since it was made is due again, with what it reaches.
void look_again(std::vector<Watched>& frames, WholeFiles& watch) {
  for (Watched& one : frames) {
    one.now = stamp_of(one.record->job.sources(), [&](const auto& file) { return watch.whole(file); });
    if (!one.made && !one.due) one.made = one.now;  // up to date when the run began
  }
  for (Watched& one : frames) {
    if (one.doubted && one.now && one.made && *one.now == *one.made && !grows(one, watch)) one.due = true;
  }
  const auto changed = counts(frames, [](const Watched& one) { return one.made && one.now && *one.now != *one.made; });
  for (std::size_t i = 0; i < frames.size(); ++i)
    if (changed[i + 1] > changed[frames[i].first]) frames[i].due = true;
}

/// Those that are due, and whose files and those of the frames before them are whole.
std::vector<Watched*> can_be_made(std::vector<Watched>& frames) {
  const auto missing = counts(frames, [](const Watched& one) { return !one.now; });
  std::vector<Watched*> out;
  for (std::size_t i = 0; i < frames.size(); ++i)
    if (frames[i].due && missing[i + 1] == missing[frames[i].first]) out.push_back(&frames[i]);
  return out;
}

/// Tells of what failed, but of what may have failed for being half written when that has been tried again.
void tell_failures(const std::vector<Watched*>& batch, WholeFiles& watch, const RunEvents& events) {
  for (Watched* one : batch) {
    const auto& error = one->record->error;
    one->doubted = error && error->kind == ErrorKind::io && grows(*one, watch);
    if (one->doubted) {
      events.note(error->text() + " (it was written a moment ago: tried again)");
    } else if (error) {
      events.failed(*error);
    }
  }
}

/// The first frame that found no room, and those before it that failed for other reasons.
void tell_until_full(const std::vector<Watched*>& batch, const RunEvents& events) {
  for (const Watched* one : batch) {
    if (!one->record->error) continue;
    events.failed(*one->record->error);
    if (is_disk_full(*one->record->error)) return;
  }
}

/// What is left when nothing is tried again.
void tell_doubted(std::vector<Watched>& frames, const RunEvents& events) {
  for (Watched& one : frames)
    if (std::exchange(one.doubted, false) && one.record->error) events.failed(*one.record->error);
}

}  // namespace

Result<void> run_watching(FrameRecords& frames, int earlier, bool fail_fast, const RunEvents& events,
                          const std::function<Result<void>()>& run) {
  WholeFiles watch = watch_inputs(frames);
  std::vector<Watched> watched = watched_frames(frames, earlier);
  for (;;) {
    look_again(watched, watch);
    const std::vector<Watched*> batch = can_be_made(watched);
    std::vector<State> kept;
    for (auto& one : watched) kept.push_back(std::exchange(one.record->state, State::up_to_date));
    for (Watched* one : batch) {
      one->record->state = State::waiting;
      one->record->error.reset();
      one->doubted = false;
    }
    const Result<void> done = batch.empty() ? Result<void>() : run();
    for (std::size_t i = 0, made = 0; i < watched.size(); ++i) {
      if (made < batch.size() && batch[made] == &watched[i]) {
        ++made;
      } else {
        watched[i].record->state = kept[i];
      }
    }
    const bool full = std::ranges::any_of(
        batch, [](const Watched* one) { return one->record->error && is_disk_full(*one->record->error); });
    if (!done && (fail_fast || full || done.error().kind != ErrorKind::io)) {
      tell_doubted(watched, events);
      if (full && batch.size() > 1) tell_until_full(batch, events);
      return done;
    }
    for (Watched* one : batch) {
      one->due = false;
      one->made = one->now;
    }
    tell_failures(batch, watch, events);
    const auto is_done = [](const Watched& one) {
      const bool being_written = !one.now && is_file(one.record->job.input);
      return !one.due && !being_written && (one.record->state == State::done || one.record->state == State::up_to_date);
    };
    if (batch.empty() && std::ranges::all_of(watched, is_done)) return {};
    if (events.interrupted()) {
      tell_doubted(watched, events);
      const auto count = std::ranges::count_if(watched, is_done);
      return Error{ErrorKind::interrupted, fmt::format("interrupted after {} of {} frames; --resume goes on from there",
                                                       count, watched.size())};
    }
    if (batch.empty()) watch.wait();
  }
}

}  // namespace afterglow
