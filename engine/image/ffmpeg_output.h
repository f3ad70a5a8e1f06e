// SPDX-License-Identifier: MIT
// A container that FFmpeg writes into an OutputFile.
#pragma once

#include <filesystem>
#include <memory>

#include "core/result.h"
#include "image/ffmpeg_handles.h"
#include "image/output_file.h"

namespace afterglow {

/// Not thread-safe. Errors: io.
class FfmpegOutput {
 public:
  /// `muxer`: FFmpeg's name. `path` is where `out` lies: some muxers read their file again at its end.
  static Result<std::unique_ptr<FfmpegOutput>> open(const char* muxer, OutputFile& out,
                                                    const std::filesystem::path& path);
  ~FfmpegOutput();
  FfmpegOutput(const FfmpegOutput&) = delete;
  FfmpegOutput& operator=(const FfmpegOutput&) = delete;

  AVFormatContext& container() { return *container_; }
  /// Behind all streams. `options`: the muxer's own.
  Result<void> begin(AVDictionary** options);
  /// Takes the packet's content; packets of one stream come by rising decoding times.
  Result<void> write(AVPacket& packet);
  Result<void> finish();

 private:
  explicit FfmpegOutput(OutputFile& out, std::filesystem::path path) : out_(out), path_(std::move(path)) {}
  static int open_again(AVFormatContext* container, AVIOContext** io, const char* url, int flags,
                        AVDictionary** options);

  OutputFile& out_;
  std::filesystem::path path_;
  AVFormatContext* container_ = nullptr;
};

}  // namespace afterglow
