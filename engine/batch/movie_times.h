// SPDX-License-Identifier: MIT
// What a run says of the times of a video's frames, before any work.
#pragma once

#include <string>
#include <vector>

#include "batch/frame_list.h"
#include "core/diagnostics.h"

namespace afterglow {

/// `fps`: what --fps asks for, which is for pictures; a video's frames have times of their own.
void tell_of_own_times(double fps, const std::vector<FrameJob>& frames, Diagnostics& diagnostics);

/// Of an output that is no video: frames that come at no even rate lose their times.
void tell_of_lost_times(const std::string& output, const std::vector<FrameJob>& frames, Diagnostics& diagnostics);

}  // namespace afterglow
