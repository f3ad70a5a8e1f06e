// SPDX-License-Identifier: MIT
// Frames to packets to a file, by FFmpeg: what FfmpegModule has for video_writer.h.
#pragma once

#include <string>

#include "image/video_writer.h"

namespace afterglow {

bool has_ffmpeg_encoder(const std::string& name);

/// `path` is where `out` lies, `name` what messages call the file. Errors: io, usage (what the encoder refuses).
Result<std::unique_ptr<VideoEncoder>> encode_with_ffmpeg(const VideoPlan& plan, OutputFile& out,
                                                         const std::filesystem::path& path, const std::string& name,
                                                         Diagnostics& diagnostics);

}  // namespace afterglow
