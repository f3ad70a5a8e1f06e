// SPDX-License-Identifier: MIT
#include "image/ffmpeg_sound.h"

extern "C" {
#include <libavutil/channel_layout.h>
#include <libavutil/mathematics.h>
#include <libavutil/opt.h>
}

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "image/ffmpeg_clock.h"
#include "image/ffmpeg_input.h"
#include "image/ffmpeg_samples.h"

namespace afterglow {
namespace {

constexpr std::int64_t kRate = SoundTrack::kRate;
/// Decoders need packets before the one that is wanted: 80 ms of Opus, a frame of AAC, the reservoir of MP3.
constexpr std::int64_t kPreroll = kRate / 4;
/// What comes this much later is decoded on the way, not sought.
constexpr std::int64_t kNear = 2 * kRate;
/// Stamps of some containers are round: a difference below this is none.
constexpr std::int64_t kRound = kRate / 100;
/// Places in files whose clock starts anew are so far apart.
constexpr std::int64_t kApart = AV_TIME_BASE / 2;
/// As with pictures: decoders that strangers' files may reach.
constexpr const char* kCodecs =
    "aac,mp3,mp3float,mp2,mp2float,mp1,mp1float,opus,libopus,vorbis,libvorbis,flac,alac,ac3,eac3,wavpack,tta,"
    "pcm_s8,pcm_u8,pcm_s16le,pcm_s16be,pcm_s24le,pcm_s24be,pcm_s32le,pcm_s32be,pcm_f32le,pcm_f32be,pcm_f64le,"
    "pcm_f64be,pcm_alaw,pcm_mulaw,pcm_bluray,pcm_dvd,adpcm_ima_wav,adpcm_ms,wmav1,wmav2,dvaudio";

/// Negative: there is none. MPEG streams tell of rates in the sound itself, which was passed over while the pictures
/// were looked for: there is no best one then, and decoders find out the rest.
int best_sound(AVFormatContext& container) {
  const int best = av_find_best_stream(&container, AVMEDIA_TYPE_AUDIO, -1, -1, nullptr, 0);
  if (best >= 0) return best;
  for (unsigned i = 0; i < container.nb_streams; ++i) {
    const AVCodecParameters& parameters = *container.streams[i]->codecpar;
    if (parameters.codec_type == AVMEDIA_TYPE_AUDIO && parameters.codec_id != AV_CODEC_ID_NONE)
      return static_cast<int>(i);
  }
  return -1;
}

class FfmpegSound : public SoundTrack {
 public:
  /// False: there is no sound.
  Result<bool> open(const MovieRequest& request, double start, const std::vector<ClockPart>& clock) {
    name_ = request.file.string();
    AFTERGLOW_TRY(input_, FfmpegInput::open(request.file, request.format, request.limits, request.patience));
    AVFormatContext& container = input_->container();
    stream_ = best_sound(container);
    if (stream_ < 0) return false;
    for (unsigned i = 0; i < container.nb_streams; ++i)
      container.streams[i]->discard = static_cast<int>(i) == stream_ ? AVDISCARD_DEFAULT : AVDISCARD_ALL;
    const AVStream& stream = *container.streams[stream_];
    const AVCodec* codec = avcodec_find_decoder(stream.codecpar->codec_id);
    if (!codec || !is_sound_decoder(*codec))
      return Error{
          ErrorKind::io,
          std::string("has sound whose codec is not read (") + avcodec_get_name(stream.codecpar->codec_id) + ")",
          name_};
    codec_.reset(avcodec_alloc_context3(codec));
    packet_.reset(av_packet_alloc());
    frame_.reset(av_frame_alloc());
    if (!codec_ || !packet_ || !frame_ || avcodec_parameters_to_context(codec_.get(), stream.codecpar) < 0)
      return Error{ErrorKind::io, "there is no memory to decode its sound", name_};
    codec_->opaque = errors_.get();
    codec_->pkt_timebase = stream.time_base;
    if (const int opened = avcodec_open2(codec_.get(), codec, nullptr); opened < 0)
      return Error{ErrorKind::io, "has sound that cannot be decoded: " + ffmpeg_error(opened), name_};
    start_ = start;
    clock_ = clock;
    rewind_ = true;  // what was read to know the streams is read again
    return true;
  }

  Result<void> read(std::int64_t first, std::span<float> to) override {
    std::fill(to.begin(), to.end(), 0.0f);
    const auto count = static_cast<std::int64_t>(to.size()) / kChannels;
    if (rewind_ || (first < held_ && !whole_) || (first > end() + kNear && !ended_)) {
      seek(first - kPreroll);
      decode_until(first + 1);
      // A container whose seeking leads elsewhere: from the start then.
      if ((!anchored_ || held_ > first) && !whole_) seek_to_start();
    }
    decode_until(first + count);
    const std::int64_t from = std::max(first, held_), until = std::min(first + count, end());
    if (from < until)
      std::transform(samples_.begin() + (from - held_) * kChannels, samples_.begin() + (until - held_) * kChannels,
                     to.begin() + (from - first) * kChannels, held_sample<float>);
    drop_before(first);
    if (auto reason = input_->given_up()) return *std::move(reason);
    return {};
  }

 private:
  /// Where a packet lies, and when it is heard: microseconds of the clock that runs on.
  struct Place {
    std::int64_t pos = 0, time = 0;
  };

  std::int64_t end() const { return held_ + static_cast<std::int64_t>(samples_.size()) / kChannels; }

  void forget() {
    samples_.clear();
    held_ = 0;
    converter_.reset();
    avcodec_flush_buffers(codec_.get());
    anchored_ = ended_ = draining_ = rewind_ = false;
  }

  bool seek_bytes(std::int64_t pos) {
    return avformat_seek_file(&input_->container(), -1, INT64_MIN, pos, INT64_MAX, AVSEEK_FLAG_BYTE) >= 0;
  }

  /// From where what is read comes behind `pos` in the file.
  void follow_from(std::int64_t pos, std::int64_t time) {
    if (clock_.empty()) return;
    follower_.emplace(clock_, input_->container().nb_streams);
    follower_->resume(stream_, pos, time);
  }

  /// The next packet by the clock that runs on. False: the end.
  bool next_packet() {
    while (input_->read(*packet_, stream_) >= 0)
      if (!follower_ || follower_->follow(*packet_, *input_->container().streams[stream_])) return true;
    return false;
  }

  /// Of the whole file: where stamps go back, FFmpeg does not find them.
  void find_places() {
    const AVRational base = input_->container().streams[stream_]->time_base;
    seek_to_start();
    for (; next_packet(); av_packet_unref(packet_.get())) {
      if (packet_->pos < 0 || packet_->dts == AV_NOPTS_VALUE) continue;
      const std::int64_t time = av_rescale_q(packet_->dts, base, kMicroseconds);
      if (places_.empty() || time >= places_.back().time + kApart) places_.push_back({packet_->pos, time});
    }
  }

  void seek_place(double seconds) {
    if (places_.empty()) find_places();
    auto place = std::ranges::upper_bound(places_, seconds * AV_TIME_BASE, {},
                                          [](const Place& one) { return static_cast<double>(one.time); });
    if (place == places_.begin() || !seek_bytes((--place)->pos)) return seek_to_start();
    forget();
    follow_from(place->pos, place->time);
    whole_ = false;
  }

  void seek(std::int64_t sample) {
    const AVRational base = input_->container().streams[stream_]->time_base;
    const double seconds = static_cast<double>(sample) / static_cast<double>(kRate) + start_;
    if (!clock_.empty() && sample > 0) return seek_place(seconds);
    const auto stamp = static_cast<std::int64_t>(std::floor(seconds / av_q2d(base)));
    if (sample <= 0 || avformat_seek_file(&input_->container(), stream_, INT64_MIN, stamp, stamp, 0) < 0)
      return seek_to_start();
    forget();
    whole_ = false;
  }

  void seek_to_start() {
    AVFormatContext& container = input_->container();
    if (!clock_.empty() || avformat_seek_file(&container, stream_, INT64_MIN, INT64_MIN / 2, INT64_MAX, 0) < 0)
      seek_bytes(0);
    forget();
    follow_from(0, AV_NOPTS_VALUE);
    whole_ = true;
  }

  void drop_before(std::int64_t first) {
    constexpr std::int64_t kKept = kRate / 2;  // what is asked for again
    const std::int64_t gone = std::min(first - kKept - held_, end() - held_);
    if (gone < kKept) return;
    samples_.erase(samples_.begin(), samples_.begin() + gone * kChannels);
    held_ += gone;
    whole_ = false;
  }

  /// One frame of the decoder at least, unless the file ends.
  void decode_until(std::int64_t until) {
    while (!ended_ && (!anchored_ || end() < until)) {
      const int got = avcodec_receive_frame(codec_.get(), frame_.get());
      if (got == 0) {
        take(*frame_);
        av_frame_unref(frame_.get());
      } else if (got == AVERROR(EAGAIN) && !draining_) {
        draining_ = !next_packet();
        avcodec_send_packet(codec_.get(), draining_ ? nullptr : packet_.get());  // what it cannot take is silent
        av_packet_unref(packet_.get());
      } else if (got == AVERROR_EOF || draining_) {
        ended_ = true;
      }
    }
  }

  bool fits(const AVFrame& frame) {
    const bool same =
        converter_ && frame.sample_rate == rate_ && frame.format == format_ && frame.ch_layout.nb_channels == channels_;
    if (same) return true;
    const AVChannelLayout stereo = AV_CHANNEL_LAYOUT_STEREO;
    converter_ = converter_between(frame, frame.ch_layout, stereo, AV_SAMPLE_FMT_FLT, static_cast<int>(kRate));
    if (!converter_) return false;
    rate_ = frame.sample_rate;
    format_ = frame.format;
    channels_ = frame.ch_layout.nb_channels;
    return true;
  }

  void take(const AVFrame& frame) {
    if (frame.sample_rate < 1 || !fits(frame)) return;
    place(frame);
    const int room = swr_get_out_samples(converter_.get(), frame.nb_samples);
    if (room <= 0) return;
    const std::size_t before = samples_.size();
    samples_.resize(before + static_cast<std::size_t>(room) * kChannels);
    auto* out = reinterpret_cast<std::uint8_t*>(samples_.data() + before);
    const int made = swr_convert(converter_.get(), &out, room, const_cast<const std::uint8_t**>(frame.extended_data),
                                 frame.nb_samples);
    samples_.resize(before + static_cast<std::size_t>(std::max(made, 0)) * kChannels);
  }

  /// Where the frame's samples belong: behind those before, or where its stamp says when that is elsewhere.
  void place(const AVFrame& frame) {
    const std::int64_t stamp = frame.best_effort_timestamp;
    const double seconds = static_cast<double>(stamp) * av_q2d(codec_->pkt_timebase) - start_;
    if (stamp == AV_NOPTS_VALUE || !(std::abs(seconds) < double{kFarthestSound})) {
      if (!std::exchange(anchored_, true)) held_ = 0;
      return;
    }
    // What the converter still holds comes first.
    const std::int64_t at =
        std::llround(seconds * static_cast<double>(kRate)) - swr_get_delay(converter_.get(), static_cast<int>(kRate));
    if (!std::exchange(anchored_, true)) {
      samples_.clear();
      held_ = at;
    } else if (at > end() + kRound && at - end() < 60 * kRate) {
      samples_.resize(samples_.size() + static_cast<std::size_t>(at - end()) * kChannels);  // a hole: silence
    } else if (at < end() - kRound || at > end() + kRound) {
      samples_.clear();
      held_ = at;
      whole_ = false;
    }
  }

  std::string name_;
  std::unique_ptr<FfmpegErrors> errors_ = std::make_unique<FfmpegErrors>(0);
  std::unique_ptr<FfmpegInput> input_;
  int stream_ = 0;
  CodecHandle codec_;
  PacketHandle packet_;
  FrameHandle frame_;
  SwrHandle converter_;
  int rate_ = 0, format_ = -1, channels_ = 0;
  double start_ = 0;
  std::vector<ClockPart> clock_;  ///< where the file's starts anew
  std::optional<ClockFollower> follower_;
  std::vector<Place> places_;   ///< by rising times
  std::vector<float> samples_;  ///< decoded, from frame `held_` on
  std::int64_t held_ = 0;
  bool whole_ = false;  ///< nothing comes before `held_`
  bool rewind_ = false, anchored_ = false, draining_ = false, ended_ = false;
};

}  // namespace

bool is_sound_decoder(const AVCodec& codec) { return is_among(codec, kCodecs); }

Result<std::unique_ptr<SoundTrack>> open_sound_with_ffmpeg(const MovieRequest& request, double start,
                                                           const std::vector<ClockPart>& clock) {
  auto sound = std::make_unique<FfmpegSound>();
  AFTERGLOW_TRY(const bool any, sound->open(request, start, clock));
  return any ? std::unique_ptr<SoundTrack>(std::move(sound)) : nullptr;
}

}  // namespace afterglow
