// SPDX-License-Identifier: MIT
// What a run has to say for itself: --stats as text, --report as JSON.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "batch/frame_list.h"
#include "batch/non_finite_json.h"
#include "batch/non_finite_record.h"
#include "session/session.h"

namespace afterglow {

/// Where a frame's time went, in milliseconds. Reading and writing overlap other frames' work.
struct FrameSteps {
  double plan = 0;  ///< its header, and what the preset says of it
  /// From the file until the picture was ready; `decode`: without waiting for the file, as far as that is known (EXR of
  /// ZIP; other decoders read as they go).
  double read = 0, decode = 0;
  /// Until it was whole on disk, or in the video; `encode`: without waiting for the file.
  double encode = 0, write = 0;
  /// That nothing else could begin until it was read; until frames before it were written.
  double waited_read = 0, waited_write = 0;
};

/// Null: nothing. Frames that skip the same have the same list, so that long sequences do not fill memory with it.
using SharedSkips = std::shared_ptr<const std::vector<Skipped>>;

/// Channels that the colour and the other inputs of a frame were taken from, shared likewise.
using SharedChannels = std::shared_ptr<const std::map<std::string, std::string>>;

/// What became of one frame.
struct FrameRecord {
  FrameJob job;
  enum class State { waiting, done, up_to_date, failed } state = State::waiting;
  std::optional<Error> error;
  Size size;
  FrameSteps steps;
  FrameTimes times;
  FrameNonFinite non_finite;
  SharedSkips skipped;       ///< what this frame did not run because of its content
  SharedChannels taken;      ///< null: its header was not read
  bool begins_shot = false;  ///< nothing was handed on to it, though a frame is before it
};

/// Those of standard input grow in number, and others point at them.
using FrameRecords = std::deque<FrameRecord>;

struct RunReport {
  std::optional<SessionReport> session;  ///< empty when it could not be opened
  FrameRecords frames;
  std::size_t pre_roll = 0;  ///< earlier frames that were run besides, for what they hand on
  double startup = 0;        ///< from the start of the program until the first frame can begin; script not included
  double wall = 0;           ///< from the start of the program to now
  double frames_wall = 0;    ///< from the first frame's beginning until the last was written
  double processors = 0;     ///< milliseconds of processors in that time, of all threads
  /// What is to be written besides (BatchRequest::beside) takes the place of nothing that is known to be read: only
  /// then may a report be written there.
  bool replaces_nothing = false;
  std::uint64_t memory_needed = 0;  ///< estimate that was held against --max-memory, of the largest frame
};

/// Milliseconds of processors that this process has used so far.
double processor_milliseconds();
/// Largest resident size of this process so far, in bytes.
std::uint64_t peak_memory();

/// Table of steps; with `passes` also one line a pass.
std::string report_text(const RunReport& report, bool passes);
std::string report_json(const RunReport& report);

}  // namespace afterglow
