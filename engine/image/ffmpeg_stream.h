// SPDX-License-Identifier: MIT
// Frames of a video as they come, from what cannot be sought in.
#pragma once

#include <memory>

#include "image/movie_source.h"

namespace afterglow {

/// Errors: io, usage (options that the demuxer does not take).
Result<std::unique_ptr<MovieFrames>> stream_with_ffmpeg(const StreamRequest& request);

}  // namespace afterglow
