// SPDX-License-Identifier: MIT
// The frames of a run while a renderer still writes them.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "batch/run_events.h"
#include "batch/run_report.h"

namespace afterglow {

/// Calls `run` for frames that are whole, in state `waiting` (all others are not), as they appear and again when they
/// change, until each of `frames` is done. `earlier`: so many frames before a frame reach its pixels; they must be
/// whole too, and when one changes the frame is made again. Errors: interrupted, and those of `run` but for frames that
/// failed: these are told, and made again when they change (`fail_fast`: they end it too).
Result<void> run_watching(FrameRecords& frames, int earlier, bool fail_fast, const RunEvents& events,
                          const std::function<Result<void>()>& run);

}  // namespace afterglow
