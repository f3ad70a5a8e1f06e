// SPDX-License-Identifier: MIT
// A container opened by FFmpeg: one file and nothing else, one demuxer and no other, one video stream.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "image/ffmpeg_bytes.h"
#include "image/ffmpeg_color.h"
#include "image/ffmpeg_handles.h"
#include "image/ffmpeg_log.h"
#include "image/movie_source.h"
#include "image/size_limits.h"

namespace afterglow {

/// By FFmpeg's names of codecs, with commas between them.
bool is_among(const AVCodec& codec, const std::string& names);

/// Not thread-safe.
class FfmpegInput {
 public:
  /// Reads the header and what is needed to know the stream. `format`: see MovieRequest. `options` are the demuxer's
  /// own, as "name=value:name=value". Errors: io (no such file, malformed, no video stream, a codec that is not read,
  /// sides beyond the limits, no bytes come), interrupted.
  static Result<std::unique_ptr<FfmpegInput>> open(const std::filesystem::path& file, const std::string& format,
                                                   const SizeLimits& limits, const Patience& patience);
  /// The same from a descriptor that cannot seek.
  static Result<std::unique_ptr<FfmpegInput>> open(const StreamRequest& request);
  ~FfmpegInput();

  AVFormatContext& container() { return *container_; }
  const AVFormatContext& container() const { return *container_; }
  AVStream& stream() { return *container_->streams[stream_]; }
  const AVCodec& codec() const { return *codec_; }
  /// A decoder for the stream, opened. `errors` counts what it complains of and outlives it. `careful`: on one thread,
  /// where it tells of each frame whether it is damaged; on several that gets lost. Errors: io.
  Result<CodecHandle> open_decoder(FfmpegErrors& errors, bool careful) const;
  /// The next packet of the stream, in place of what `packet` held: 0, AVERROR_EOF, or another error of FFmpeg.
  int read(AVPacket& packet) { return read(packet, stream_); }
  /// The same of another stream.
  int read(AVPacket& packet, int stream);
  /// Why there is no use in reading on, when that is so: no bytes come, nobody waits for them any more, or the demuxer
  /// reads on and on and finds no packet. It stays so.
  std::optional<Error> given_up() const;
  /// Once the end has come: it came within something.
  bool ends_early();
  /// Its pictures have an alpha in a track of its own, which is not read.
  bool leaves_alpha() const;
  /// What the container says of the stream's colours, whatever the stream says itself.
  SaidColor said_around() const;

 private:
  FfmpegInput() = default;
  static Result<std::unique_ptr<FfmpegInput>> open(std::unique_ptr<FfmpegBytes> bytes, const std::string& name,
                                                   const std::string& format, const SizeLimits& limits,
                                                   const std::string& options);
  Result<void> open_container(const std::string& format, const std::string& options);
  bool is_picture_sequence() const;
  int first_pictures() const;
  Result<void> choose_stream();
  Error failed(const std::string& why) const;

  std::string name_, format_;
  SizeLimits limits_;
  std::unique_ptr<FfmpegBytes> bytes_;
  FfmpegRemarks remarks_;
  AVFormatContext* container_ = nullptr;
  int stream_ = 0;
  std::vector<SaidColor> said_;  ///< by the container of each stream
  std::uint64_t last_ = 0;       ///< where the data of the last packet end
  const AVCodec* codec_ = nullptr;
};

}  // namespace afterglow
