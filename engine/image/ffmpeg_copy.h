// SPDX-License-Identifier: MIT
// Sound, subtitles, chapters and texts of one file go into another as they are, packet by packet.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "core/diagnostics.h"
#include "core/result.h"
#include "image/ffmpeg_handles.h"
#include "image/ffmpeg_output.h"
#include "image/video_output.h"

namespace afterglow {

/// Not thread-safe. Errors: io.
class FfmpegCopy {
 public:
  /// Adds to `output` a stream for each of `file` that it can hold; others are named in a warning. `sound_only`: no
  /// subtitles, chapters and texts.
  static Result<std::unique_ptr<FfmpegCopy>> open(const std::filesystem::path& file, bool sound_only,
                                                  FfmpegOutput& output, const CopyRange& range, const std::string& name,
                                                  Diagnostics& diagnostics);
  ~FfmpegCopy();

  /// Writes what comes before `until` (microseconds of the output's clock).
  Result<void> copy(std::int64_t until);

 private:
  explicit FfmpegCopy(FfmpegOutput& output) : output_(output) {}
  Result<void> add_streams(bool sound_only, const std::string& name, Diagnostics& diagnostics);
  void add_chapters();
  Result<void> put(AVPacket& packet);

  FfmpegOutput& output_;
  std::filesystem::path file_;
  AVFormatContext* input_ = nullptr;
  std::vector<int> target_;  ///< of each stream; −1: none
  PacketHandle waiting_;     ///< read, and later than the last `until`
  CopyRange range_;
  bool ended_ = false;
};

}  // namespace afterglow
