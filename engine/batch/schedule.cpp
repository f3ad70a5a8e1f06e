// SPDX-License-Identifier: MIT
#include "batch/schedule.h"

#include <algorithm>
#include <map>

#include "image/sequence.h"

namespace afterglow {
namespace {

/// The frames of one sequence that there are, by number.
using Frames = std::map<int, FrameJob>;

/// Asked for, and on disk.
Frames frames_of(const std::string& sequence, const FrameRecords& records, const FrameListRequest& request) {
  Frames frames;
  if (const auto pattern = parse_pattern(sequence); pattern && pattern->numbered)
    if (const auto files = find_frames(*pattern, std::nullopt))
      for (const auto& file : *files)
        if (auto job = job_of(request, sequence, file)) frames.emplace(file.frame, std::move(job).value());
  // Those of a video are all there; of a stream, only what comes.
  const auto own = std::ranges::find(records, sequence, [](const FrameRecord& r) { return r.job.sequence; });
  if (own != records.end() && own->job.movie && !own->job.passing)
    for (int frame = 0; frame < own->job.movie->frames(); ++frame)
      if (auto job = job_of(request, own->job.movie, frame)) frames.emplace(frame + 1, std::move(job).value());
  for (const auto& record : records)
    if (record.job.sequence == sequence) frames.insert_or_assign(record.job.frame, record.job);
  return frames;
}

/// Sequences in the order in which they were given.
std::vector<std::string> sequences_of(const FrameRecords& records) {
  std::vector<std::string> out;
  for (const auto& record : records)
    if (std::ranges::find(out, record.job.sequence) == out.end()) out.push_back(record.job.sequence);
  return out;
}

std::vector<FrameRecord*> waiting_by_number(const std::string& sequence, FrameRecords& records) {
  std::vector<FrameRecord*> out;
  for (auto& record : records)
    if (record.job.sequence == sequence && record.state == FrameRecord::State::waiting) out.push_back(&record);
  std::ranges::stable_sort(out, {}, [](const FrameRecord* record) { return record->job.frame; });
  return out;
}

/// The frames before `frame`, nearest first: `most` of them, fewer where `stop` is met.
std::vector<const FrameJob*> before(const Frames& frames, int frame, int most, const int* stop) {
  std::vector<const FrameJob*> out;
  for (auto at = frames.lower_bound(frame); at != frames.begin() && static_cast<int>(out.size()) < most;) {
    --at;
    if (stop && at->first <= *stop) break;
    out.push_back(&at->second);
  }
  return out;
}

void add_sequence(Schedule& out, const Frames& frames, const std::vector<FrameRecord*>& waiting, int pre_roll) {
  const int* last = nullptr;  // number of the frame that runs before
  for (FrameRecord* record : waiting) {
    const int frame = record->job.frame;
    const auto between = before(frames, frame, pre_roll, last);
    // What the frames between reach back to: the one that ran last, or nothing that is known.
    const int first = between.empty() ? frame : between.back()->frame;
    const auto one_more = before(frames, first, 1, nullptr);
    const bool follows = last && !one_more.empty() && one_more.front()->frame == *last;
    for (auto job = between.rbegin(); job != between.rend(); ++job) {
      out.earlier.push_back({.job = **job});
      // Of the kind that is asked for, so that one program makes both; it is not written.
      out.earlier.back().job.output = record->job.output;
      out.frames.push_back({&out.earlier.back(), true, !follows && job == between.rbegin()});
    }
    out.frames.push_back({record, false, !follows && between.empty()});
    last = &record->job.frame;
  }
}

}  // namespace

namespace {

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

Schedule schedule_with_histories(FrameRecords& frames, const FrameListRequest& request, int pre_roll) {
  Schedule out;
  for (const auto& sequence : sequences_of(frames))
    add_sequence(out, frames_of(sequence, frames, request), waiting_by_number(sequence, frames), pre_roll);
  return counted(std::move(out));
}

void note_earlier_files(FrameRecords& frames, const FrameListRequest& request, int pre_roll) {
  for (const auto& sequence : sequences_of(frames)) {
    const Frames there = frames_of(sequence, frames, request);
    for (auto& record : frames) {
      if (record.job.sequence != sequence) continue;
      for (const FrameJob* job : before(there, record.job.frame, pre_roll, nullptr))
        for (auto& file : job->sources()) record.job.earlier.push_back(std::move(file));
    }
  }
}

}  // namespace afterglow
