// SPDX-License-Identifier: MIT
// Subtitles that are text, from one codec into another, for containers that do not hold the first.
#pragma once

#include <memory>
#include <vector>

#include "core/result.h"
#include "image/ffmpeg_handles.h"

namespace afterglow {

/// Not thread-safe.
class FfmpegSubtitles {
 public:
  /// The codec that `format` holds text in; none where it holds none.
  static AVCodecID codec_for(const AVOutputFormat& format);
  /// Null where the stream is no text, or FFmpeg has no decoder or encoder for it.
  static std::unique_ptr<FfmpegSubtitles> open(const AVStream& from, const AVOutputFormat& format);

  /// What the stream of the other codec is.
  const AVCodecContext& encoder() const { return *encoder_; }
  /// The packet's content in the other codec; time stamps stay. False: it holds nothing that shows, or is damaged.
  bool convert(AVPacket& packet);

 private:
  FfmpegSubtitles() = default;

  CodecHandle decoder_, encoder_;
  std::vector<std::uint8_t> text_;
};

}  // namespace afterglow
