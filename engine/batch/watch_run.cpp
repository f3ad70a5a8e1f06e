// SPDX-License-Identifier: MIT
#include "batch/watch_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/file.h"
#include "core/whole_files.h"

namespace afterglow {
namespace {

using State = FrameRecord::State;

/// A frame that is waited for.
struct Watched {
  FrameRecord* record = nullptr;
  std::vector<std::size_t> before;  ///< frames that reach its pixels
  std::optional<Hash> now, made;    ///< its files as they are, and as they were when it was made last
  bool due = true;                  ///< it is to be made
};

/// By number within each sequence.
std::vector<Watched> watched_frames(FrameRecords& frames, int earlier) {
  std::vector<Watched> out;
  for (auto& frame : frames) out.push_back({.record = &frame, .due = frame.state == State::waiting});
  std::ranges::stable_sort(
      out, {}, [](const Watched& one) { return std::pair(one.record->job.sequence, one.record->job.frame); });
  for (std::size_t i = 0; i < out.size(); ++i)
    for (std::size_t k = i; k-- > 0 && i - k <= static_cast<std::size_t>(earlier);)
      if (out[k].record->job.sequence == out[i].record->job.sequence) out[i].before.push_back(k);
  return out;
}

WholeFiles watch_inputs(const FrameRecords& frames) {
  std::set<std::filesystem::path> folders;
  for (const auto& frame : frames)
    for (const auto& file : frame.job.sources()) folders.insert(file.parent_path());
  return WholeFiles(folders);
}

/// Looks at all files once more; what has changed since it was made is due again, with what it reaches.
void look_again(std::vector<Watched>& frames, WholeFiles& watch) {
  std::vector<bool> changed(frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    Watched& one = frames[i];
    one.now = stamp_of(one.record->job.sources(), [&](const auto& file) { return watch.whole(file); });
    if (!one.made && !one.due) one.made = one.now;  // up to date when the run began
    changed[i] = one.made && one.now && *one.now != *one.made;
  }
  for (std::size_t i = 0; i < frames.size(); ++i)
    if (changed[i] || std::ranges::any_of(frames[i].before, [&](std::size_t k) { return changed[k]; }))
      frames[i].due = true;
}

bool can_be_made(const std::vector<Watched>& frames, const Watched& one) {
  return one.due && one.now &&
         std::ranges::all_of(one.before, [&](std::size_t k) { return frames[k].now.has_value(); });
}

}  // namespace

Result<void> run_watching(FrameRecords& frames, int earlier, bool fail_fast, const RunEvents& events,
                          const std::function<Result<void>()>& run) {
  WholeFiles watch = watch_inputs(frames);
  std::vector<Watched> watched = watched_frames(frames, earlier);
  for (;;) {
    look_again(watched, watch);
    std::vector<Watched*> batch;
    std::vector<State> kept;
    for (auto& one : watched) {
      kept.push_back(one.record->state);
      one.record->state = can_be_made(watched, one) ? State::waiting : State::up_to_date;
      if (one.record->state != State::waiting) continue;
      one.record->error.reset();
      batch.push_back(&one);
    }
    const Result<void> done = batch.empty() ? Result<void>() : run();
    for (std::size_t i = 0; i < watched.size(); ++i)
      if (std::ranges::find(batch, &watched[i]) == batch.end()) watched[i].record->state = kept[i];
    if (!done && (fail_fast || done.error().kind != ErrorKind::io)) return done;
    for (Watched* one : batch) {
      one->due = false;
      one->made = one->now;
    }
    if (batch.size() == 1 && !done) events.failed(done.error());  // of several the run tells each
    const auto is_done = [](const Watched& one) {
      const bool being_written = !one.now && is_file(one.record->job.input);
      return !one.due && !being_written && (one.record->state == State::done || one.record->state == State::up_to_date);
    };
    if (batch.empty() && std::ranges::all_of(watched, is_done)) return {};
    if (events.interrupted()) {
      const auto count = std::ranges::count_if(watched, is_done);
      return Error{ErrorKind::interrupted, fmt::format("interrupted after {} of {} frames; --resume goes on from there",
                                                       count, watched.size())};
    }
    if (batch.empty()) watch.wait();
  }
}

}  // namespace afterglow
