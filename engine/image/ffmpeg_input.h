// SPDX-License-Identifier: MIT
// A container opened by FFmpeg: one file and nothing else, one demuxer and no other, one video stream.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/file_descriptor.h"
#include "core/result.h"
#include "image/ffmpeg_handles.h"
#include "image/ffmpeg_log.h"
#include "image/size_limits.h"

namespace afterglow {

/// Not thread-safe.
class FfmpegInput {
 public:
  /// Reads the header and what is needed to know the stream. `format`: see MovieRequest. `options` are the demuxer's
  /// own, as "name=value:name=value". Errors: io (no such file, malformed, no video stream, a codec that is not read,
  /// sides beyond the limits).
  static Result<std::unique_ptr<FfmpegInput>> open(const std::filesystem::path& file, const std::string& format,
                                                   const SizeLimits& limits, const std::string& options = {});
  /// The same from a descriptor that cannot seek; see StreamRequest.
  static Result<std::unique_ptr<FfmpegInput>> open(std::shared_ptr<FileDescriptor> from, const std::string& name,
                                                   const std::string& format, const SizeLimits& limits,
                                                   const std::string& options = {}, const std::string& head = {},
                                                   const std::atomic<bool>* cancelled = nullptr);
  ~FfmpegInput();

  AVFormatContext& container() { return *container_; }
  AVStream& stream() { return *container_->streams[stream_]; }
  const AVCodec& codec() const { return *codec_; }
  /// A decoder for the stream, opened. `errors` counts what it complains of and outlives it. `careful`: on one thread,
  /// where it tells of each frame whether it is damaged; on several that gets lost. Errors: io.
  Result<CodecHandle> open_decoder(FfmpegErrors& errors, bool careful) const;
  /// The next packet of the stream: 0, AVERROR_EOF, or another error of FFmpeg.
  int read(AVPacket& packet);

 private:
  FfmpegInput() = default;
  Result<void> open_container(const std::string& format, const std::string& options);
  Result<void> choose_stream();
  Error failed(const std::string& why) const;

  std::string name_;
  SizeLimits limits_;
  struct Bytes {
    std::shared_ptr<FileDescriptor> from;
    std::string head;       ///< comes first
    std::size_t given = 0;  ///< of it
    const std::atomic<bool>* cancelled = nullptr;
  } bytes_;
  static int read_bytes(void* opaque, std::uint8_t* to, int size);
  static std::int64_t seek_bytes(void* opaque, std::int64_t to, int whence);
  bool seekable_ = true;
  AVIOContext* io_ = nullptr;
  AVFormatContext* container_ = nullptr;
  int stream_ = 0;
  const AVCodec* codec_ = nullptr;
};

}  // namespace afterglow
