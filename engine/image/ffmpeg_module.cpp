// SPDX-License-Identifier: MIT
#include "image/ffmpeg_module.h"

#include "core/module.h"

namespace afterglow {
namespace {

Result<const FfmpegModule*> load_ffmpeg_module() {
#ifdef AFTERGLOW_HAS_FFMPEG
  auto entry = load_module("afterglow_ffmpeg.so", "afterglow_ffmpeg_module");
  if (!entry) return Error{ErrorKind::io, "videos cannot be read or written: " + entry.error().message};
  return reinterpret_cast<const FfmpegModule* (*)()>(*entry)();
#else
  return Error{ErrorKind::io, "videos cannot be read or written: this Afterglow was built without FFmpeg"};
#endif
}

}  // namespace

Result<const FfmpegModule*> ffmpeg_module() {
  static const Result<const FfmpegModule*> module = load_ffmpeg_module();
  return module;
}

}  // namespace afterglow
