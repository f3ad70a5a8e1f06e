// SPDX-License-Identifier: MIT
// Sound of one codec into another, for containers that do not hold the first: sample by sample in its place.
#pragma once

extern "C" {
#include <libavutil/audio_fifo.h>
}

#include <cstdint>
#include <functional>
#include <memory>

#include "core/result.h"
#include "image/ffmpeg_handles.h"
#include "image/ffmpeg_samples.h"

namespace afterglow {

/// Not thread-safe.
class FfmpegSoundEncoder {
 public:
  /// Takes what is ready: packets in units of encoder().time_base, since the output's beginning.
  using Put = std::function<Result<void>(AVPacket&)>;

  /// As many as AAC and Opus hold, and as a frame of FFmpeg has room for.
  static constexpr int kMostChannels = AV_NUM_DATA_POINTERS;

  /// Null where `format` has no codec for it, or FFmpeg no decoder that is used here.
  static std::unique_ptr<FfmpegSoundEncoder> open(const AVStream& from, const AVOutputFormat& format);

  /// What the stream of the other codec is.
  const AVCodecContext& encoder() const { return *encoder_; }
  /// The part that is heard, in microseconds of the stream's clock: its begin is the output's 0.
  void cut(std::int64_t begin, std::int64_t end);
  /// The stream's next packet. What is damaged becomes silence. Errors: io, those of `put`.
  Result<void> convert(const AVPacket& packet, const Put& put);
  /// The output has come to `until`, and the stream's next packet is later: at `next` (both in microseconds of the
  /// output's clock). What lies between is silence. Errors: as above.
  Result<void> wait(std::int64_t next, std::int64_t until, const Put& put);
  /// All that is left. Errors: as above.
  Result<void> finish(const Put& put);

 private:
  struct Deleter {
    void operator()(AVAudioFifo* samples) const { av_audio_fifo_free(samples); }
  };

  FfmpegSoundEncoder() = default;
  Result<void> decode(const AVPacket* packet, const Put& put);
  Result<void> take(AVFrame& frame, const Put& put);
  Result<void> place(const AVFrame& frame, const Put& put);
  bool fits(const AVFrame& frame);
  Result<void> add(const AVFrame& samples, std::int64_t count);
  Result<void> convert_samples(const AVFrame* frame);
  Result<void> be_silent(std::int64_t count, const Put& put);
  std::int64_t samples_at(std::int64_t time) const;
  int piece() const;
  FrameHandle room_for(std::int64_t count) const;
  Result<void> encode(std::int64_t least, const Put& put);
  Result<void> drain(const Put& put) const;

  CodecHandle decoder_, encoder_;
  FrameHandle frame_;
  SwrHandle converter_;
  int rate_ = 0, format_ = -1, channels_ = 0;      ///< that it converts from
  std::unique_ptr<AVAudioFifo, Deleter> waiting_;  ///< for the encoder
  std::int64_t begin_ = 0;                         ///< microseconds of the stream's clock
  std::int64_t end_ = INT64_MAX / 2;               ///< in samples of the output, as those below
  std::int64_t next_ = 0;                          ///< the place of the next sample that is converted
  std::int64_t doubled_ = 0;                       ///< further ones that lie over what came before them
  std::int64_t made_ = 0;                          ///< given to the encoder
  bool anchored_ = false;
};

}  // namespace afterglow
