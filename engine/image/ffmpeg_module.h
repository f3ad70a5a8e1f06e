// SPDX-License-Identifier: MIT
// FFmpeg, at arm's length: it brings a hundred shared libraries, and is loaded when the first video is read or written.
// A build without it (AFTERGLOW_FFMPEG=OFF) says so.
#pragma once

#include <memory>
#include <string>

#include "core/result.h"
#include "image/movie_source.h"
#include "image/sound.h"
#include "image/video_writer.h"

namespace afterglow {

struct FfmpegModule {
  /// "libavformat 59.27.100, libavcodec 59.37.100": what was loaded.
  std::string (*version)();
  /// See movie_source.h.
  Result<std::shared_ptr<MovieSource>> (*open)(const MovieRequest& request);
  Result<std::unique_ptr<MovieFrames>> (*stream)(const StreamRequest& request);
  /// See ffmpeg_encoder.h.
  bool (*has_encoder)(const std::string& name);
  Result<std::unique_ptr<VideoEncoder>> (*encode)(const VideoPlan& plan, OutputFile& out,
                                                  const std::filesystem::path& path, const std::string& name,
                                                  Diagnostics& diagnostics);
  /// See ffmpeg_join.h.
  Result<void> (*join)(const VideoPlan& plan, const VideoPieces& pieces, OutputFile& out,
                       const std::filesystem::path& path, const std::string& name, Diagnostics& diagnostics);
  /// See ffmpeg_sound.h.
  Result<std::unique_ptr<SoundTrack>> (*sound)(const MovieRequest& request, double start,
                                               const std::vector<ClockPart>& clock);
};

/// Loads it on the first call; thread-safe. Errors: io (not installed, built without it).
Result<const FfmpegModule*> ffmpeg_module();

}  // namespace afterglow
