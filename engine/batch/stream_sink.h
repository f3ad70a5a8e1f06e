// SPDX-License-Identifier: MIT
// All frames of a run into standard output: a y4m or raw video, pictures one behind the other.
#pragma once

#include "batch/frame_sink.h"

namespace afterglow {

/// From here on what else goes to standard output goes to standard error, so that nothing gets between the frames.
/// `format`: y4m, raw, or the extension of a picture format; empty: y4m. Errors: usage (unknown format or pixel format,
/// a terminal), io.
/// `frames`: so many are known to come.
Result<std::unique_ptr<FrameSink>> open_stream_sink(const std::string& format, const WriteOptions& options, double fps,
                                                    std::size_t frames, Diagnostics& diagnostics);

}  // namespace afterglow
