// SPDX-License-Identifier: MIT
// All frames of a run as one video.
#pragma once

#include "batch/frame_sink.h"

namespace afterglow {

/// The file appears when it is finished. `fps`: of frames that come from no video. `last`: of the frames that are asked
/// for; null: not known. Errors: usage, io.
Result<std::unique_ptr<FrameSink>> open_video_sink(const std::filesystem::path& file, const WriteOptions& options,
                                                   double fps, const FrameJob* last, Diagnostics& diagnostics);

}  // namespace afterglow
