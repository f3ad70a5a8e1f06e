// SPDX-License-Identifier: MIT
// A video file by FFmpeg: see movie_source.h.
#pragma once

#include <memory>

#include "image/movie_source.h"

namespace afterglow {

/// Indexes the whole file and decodes its first frame. Errors: io.
Result<std::shared_ptr<MovieSource>> open_with_ffmpeg(const MovieRequest& request);

}  // namespace afterglow
