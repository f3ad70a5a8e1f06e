// SPDX-License-Identifier: MIT
// Which frames run in which order, when pictures depend on the frames before them: those that were asked for, by
// number, and as many earlier ones as the histories of the stack need (their results are not written).
#pragma once

#include <functional>
#include <vector>

#include "batch/run_report.h"
#include "image/cuts.h"

namespace afterglow {

struct ScheduledFrame {
  FrameRecord* record = nullptr;
  bool pre_roll = false;  ///< run for what it hands on; not written
  bool restart = false;   ///< no frame is before it
  std::size_t index = 0;  ///< among those that are written, with the places of missing ones
};

struct Schedule {
  std::vector<ScheduledFrame> frames;
  FrameRecords earlier;  ///< records of the pre-roll
  /// When not empty, there may be more: the record of the next frame behind these, null at the end. Errors: io.
  std::function<Result<FrameRecord*>()> more;
};

/// For a stack without histories: the frames that wait, in their order.
Schedule plain_schedule(FrameRecords& frames);

/// Each sequence by ascending numbers, whatever order was asked for; where all frames go into one output, that order,
/// and what is not behind the frame before it begins anew. The frame before a frame is the one with the next
/// lower number that there is: among those asked for, and for numbered inputs on disk. So many frames before each frame
/// run first (`pre_roll`, as far as there are any), unless they run anyway; where the frames between two that are asked
/// for are more than that, the second begins anew. Nothing before a frame that is told to begin a shot runs for it.
/// Frames that are up to date run as pre-roll where they are needed.
Schedule schedule_with_histories(FrameRecords& frames, const FrameListRequest& request, int pre_roll, const Cuts& cuts);

/// Adds to each job what its output depends on besides its own files: those of so many earlier frames.
void note_earlier_files(FrameRecords& frames, const FrameListRequest& request, int pre_roll);

}  // namespace afterglow
