// SPDX-License-Identifier: MIT
// FFmpeg, at arm's length: it brings a hundred shared libraries, and is loaded when the first video is read or written.
// A build without it (AFTERGLOW_FFMPEG=OFF) says so.
#pragma once

#include <string>

#include "core/result.h"

namespace afterglow {

struct FfmpegModule {
  /// "libavformat 59.27.100, libavcodec 59.37.100": what was loaded.
  std::string (*version)();
};

/// Loads it on the first call; thread-safe. Errors: io (not installed, built without it).
Result<const FfmpegModule*> ffmpeg_module();

}  // namespace afterglow
