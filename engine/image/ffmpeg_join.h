// SPDX-License-Identifier: MIT
// Pieces become one video without a second encode: what FfmpegModule has for video_writer.h.
#pragma once

#include <string>

#include "image/video_writer.h"

namespace afterglow {

/// As join_video; `path` is where `out` lies, `name` what messages call the file.
Result<void> join_with_ffmpeg(const VideoPlan& plan, const VideoPieces& pieces, OutputFile& out,
                              const std::filesystem::path& path, const std::string& name, Diagnostics& diagnostics);

}  // namespace afterglow
