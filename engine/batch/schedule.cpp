// SPDX-License-Identifier: MIT
#include "batch/schedule.h"

#include <algorithm>
#include <map>

#include "batch/grouped.h"
#include "image/sequence.h"

namespace afterglow {
namespace {

/// The frames of one sequence that there are, by number.
using Frames = std::map<int, FrameJob>;

/// What was asked for of one sequence.
using Sequence = std::vector<FrameRecord*>;

/// In the order in which they were given.
std::vector<Sequence> sequences_of(FrameRecords& records) {
  return grouped(records, [](const FrameRecord& record) { return record.job.sequence; });
}

/// Asked for, and on disk.
Frames frames_of(const Sequence& sequence, const FrameListRequest& request) {
  Frames frames;
  const FrameJob& first = sequence.front()->job;
  if (const auto pattern = parse_pattern(first.sequence); pattern && pattern->numbered)
    if (const auto files = find_frames(*pattern, std::nullopt))
      for (const auto& file : *files)
        if (auto job = job_of(request, first.sequence, file)) frames.emplace(file.frame, std::move(job).value());
  // Those of a video are all there; of a stream, only what comes.
  if (first.movie && !first.passing)
    for (int frame = 0; frame < first.movie->frames(); ++frame)
      if (auto job = job_of(request, first.movie, frame)) frames.emplace(frame + 1, std::move(job).value());
  for (const FrameRecord* record : sequence) frames.insert_or_assign(record->job.frame, record->job);
  return frames;
}

std::vector<FrameRecord*> waiting_by_number(const Sequence& sequence) {
  std::vector<FrameRecord*> out;
  for (FrameRecord* record : sequence)
    if (record->state == FrameRecord::State::waiting) out.push_back(record);
  std::ranges::stable_sort(out, {}, [](const FrameRecord* record) { return record->job.frame; });
  return out;
}

/// Those that wait, in the order in which they were given: frames of one sequence by rising numbers, as often as the
/// sequence changes or the numbers fall.
std::vector<Sequence> waiting_in_order(FrameRecords& records) {
  std::vector<Sequence> out;
  for (FrameRecord& record : records) {
    if (record.state != FrameRecord::State::waiting) continue;
    const FrameJob* last = out.empty() ? nullptr : &out.back().back()->job;
    if (!last || last->sequence != record.job.sequence || last->frame >= record.job.frame) out.emplace_back();
    out.back().push_back(&record);
  }
  return out;
}

/// The frames of its shot before `frame`, nearest first: `most` of them, fewer where `stop` is met.
std::vector<const FrameJob*> before(const Frames& frames, int frame, int most, const int* stop, const Cuts& cuts = {}) {
  std::vector<const FrameJob*> out;
  for (auto at = frames.lower_bound(frame); at != frames.begin() && static_cast<int>(out.size()) < most;) {
    --at;
    if ((stop && at->first <= *stop) || cuts.between(at->first, frame)) break;
    out.push_back(&at->second);
  }
  return out;
}

void add_sequence(Schedule& out, const Frames& frames, const std::vector<FrameRecord*>& waiting, int pre_roll,
                  const Cuts& cuts) {
  const int* last = nullptr;  // number of the frame that runs before
  for (FrameRecord* record : waiting) {
    const int frame = record->job.frame;
    const auto between = before(frames, frame, pre_roll, last, cuts);
    // What the frames between reach back to: the one that ran last, or nothing that is known.
    const int first = between.empty() ? frame : between.back()->frame;
    const auto one_more = before(frames, first, 1, nullptr);
    const bool follows = last && !one_more.empty() && one_more.front()->frame == *last;
    for (auto job = between.rbegin(); job != between.rend(); ++job) {
      out.earlier.push_back({.job = **job});
      // Of the kind that is asked for, so that one program makes both; it is not written.
      out.earlier.back().job.output = record->job.output;
      // What it finds of its files, those behind it are noted to depend on.
      out.earlier.back().job.earlier = {record->job.earlier.of};
      out.frames.push_back({&out.earlier.back(), true, !follows && job == between.rbegin()});
    }
    out.frames.push_back({record, false, !follows && between.empty()});
    last = &record->job.frame;
  }
}

/// Those that these records look back to; no others, so that each record's lie side by side.
std::shared_ptr<const SequenceFiles> earlier_files(const Frames& there, const Sequence& records, int pre_roll) {
  std::vector<const FrameJob*> jobs;
  for (const auto& [number, job] : there) jobs.push_back(&job);
  // Of how many records look back to a frame, from the frame before.
  std::vector<std::ptrdiff_t> change(jobs.size() + 1);
  for (const FrameRecord* record : records) {
    const auto end = std::ranges::lower_bound(jobs, record->job.frame, {}, &FrameJob::frame) - jobs.begin();
    ++change[static_cast<std::size_t>(std::max<std::ptrdiff_t>(end - pre_roll, 0))];
    --change[static_cast<std::size_t>(end)];
  }
  auto out = std::make_shared<SequenceFiles>();
  std::ptrdiff_t wanted = 0;
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    wanted += change[i];
    if (wanted > 0) out->add(jobs[i]->frame, jobs[i]->sources());
  }
  return out;
}

Schedule counted(Schedule schedule) {
  std::size_t index = 0;
  for (auto& frame : schedule.frames)
    if (!frame.pre_roll) frame.index = index++ + frame.record->job.missing;
  return schedule;
}

}  // namespace

Schedule plain_schedule(FrameRecords& frames) {
  Schedule out;
  for (auto& frame : frames)
    if (frame.state == FrameRecord::State::waiting) out.frames.push_back({&frame, false, false});
  return counted(std::move(out));
}

Schedule schedule_with_histories(FrameRecords& frames, const FrameListRequest& request, int pre_roll,
                                 const Cuts& cuts) {
  Schedule out;
  std::map<std::string, Frames> there;
  for (const auto& sequence : sequences_of(frames)) {
    const auto known = there.emplace(sequence.front()->job.sequence, frames_of(sequence, request)).first;
    if (!is_one_output(request.output)) add_sequence(out, known->second, waiting_by_number(sequence), pre_roll, cuts);
  }
  if (is_one_output(request.output))
    for (const auto& run : waiting_in_order(frames))
      add_sequence(out, there.at(run.front()->job.sequence), run, pre_roll, cuts);
  return counted(std::move(out));
}

void note_earlier_files(FrameRecords& frames, const FrameListRequest& request, int pre_roll) {
  for (const auto& sequence : sequences_of(frames)) {
    const auto files = earlier_files(frames_of(sequence, request), sequence, pre_roll);
    if (files->files.empty()) continue;
    for (FrameRecord* record : sequence) {
      FrameJob& job = record->job;
      job.earlier = {files, files->first_before(job.frame, pre_roll), files->begin_of(job.frame)};
    }
  }
}

}  // namespace afterglow
