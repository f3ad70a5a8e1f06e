// SPDX-License-Identifier: MIT
// A video as FFmpeg's muxers write it: a stream of frames, and beside it what is copied from other files.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/diagnostics.h"
#include "core/result.h"
#include "image/ffmpeg_copy.h"
#include "image/ffmpeg_handles.h"
#include "image/ffmpeg_output.h"
#include "image/video_output.h"

namespace afterglow {

inline AVRational rational(const Rational& value) { return {value.numerator, value.denominator}; }

/// Not thread-safe. Errors: io.
class FfmpegVideoFile {
 public:
  /// `path` is where `out` lies. The plan outlives it.
  static Result<std::unique_ptr<FfmpegVideoFile>> open(const VideoPlan& plan, OutputFile& out,
                                                       const std::filesystem::path& path);

  /// Whether encoders are to keep what all frames share out of the packets.
  bool wants_global_header() const;
  /// The tag by which players know the codec; 0: the muxer's own choice.
  unsigned codec_tag() const;
  /// The stream of frames, once, then the head of the file. `alpha`: VP9's second stream is there. `name` is what
  /// messages call the file.
  Result<void> begin(const AVCodecParameters& frames, bool alpha, const std::string& name, Diagnostics& diagnostics);
  /// The next packet of frames, in units of the plan's time base, and before it what is to be copied.
  Result<void> write(AVPacket& packet);
  /// `end`: when the last frame goes, in the same units. `whole`: see VideoEncoder.
  Result<void> finish(bool whole, std::int64_t end);

 private:
  explicit FfmpegVideoFile(const VideoPlan& plan) : plan_(plan) {}
  Result<void> add_copies(const std::string& name, Diagnostics& diagnostics);
  void add_time_code();
  Result<void> write_head();
  void say_last_length(std::int64_t ticks);

  const VideoPlan& plan_;
  std::unique_ptr<FfmpegOutput> output_;
  std::unique_ptr<FfmpegCopy> copy_;
  AVStream* stream_ = nullptr;
  std::int64_t last_ = 0;  ///< when the last frame is shown, in ticks of the plan
};

}  // namespace afterglow
