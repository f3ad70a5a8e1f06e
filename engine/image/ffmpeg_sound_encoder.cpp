// SPDX-License-Identifier: MIT
#include "image/ffmpeg_sound_encoder.h"

extern "C" {
#include <libavutil/channel_layout.h>
#include <libavutil/mathematics.h>
#include <libavutil/samplefmt.h>
}

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "image/ffmpeg_clock.h"
#include "image/ffmpeg_log.h"
#include "image/ffmpeg_samples.h"
#include "image/ffmpeg_sound.h"

namespace afterglow {
namespace {

constexpr int kBitsASecond = 96'000;  // of each channel
constexpr int kEncodedRate = 48'000;
/// Samples at a time, where the encoder takes any number.
constexpr int kSoundPiece = 1024;
/// Stamps of some containers are round (AVI: a packet of MP3): below this part of a second a difference is none.
constexpr int kRoundStamp = 40;
/// Seconds. A hole that is longer is a broken stamp.
constexpr std::int64_t kLongestHole = 3600;
/// Seconds behind what is written. Sound that begins later has a broken stamp.
constexpr std::int64_t kLatestBegin = 24 * 3600;

Error encoding_failed(int code) { return {ErrorKind::io, "sound cannot be encoded: " + ffmpeg_error(code)}; }
Error no_sound_memory() { return {ErrorKind::io, "there is no memory to encode its sound"}; }

struct Target {
  const char* encoder = nullptr;  ///< FFmpeg's name; null: none
  AVSampleFormat format = AV_SAMPLE_FMT_NONE;
  bool any_rate = false;
};

/// Whether 16 bits hold all that the stream says.
bool fits_in_16_bits(const AVCodecParameters& sound) {
  const int raw = sound.bits_per_raw_sample, coded = sound.bits_per_coded_sample;
  return raw > 0 ? raw <= 16 : coded > 0 && coded <= 16 && av_get_exact_bits_per_sample(sound.codec_id) > 0;
}

/// Players know AAC in MP4, and Opus in WebM; what editors take loses nothing.
Target target_for(const AVOutputFormat& format, const AVCodecParameters& sound) {
  const std::string_view name = format.name;
  if (name == "mp4") return {"aac", AV_SAMPLE_FMT_FLTP};
  if (name == "webm") return {"libopus", AV_SAMPLE_FMT_FLT};
  if (name != "mov" && name != "matroska") return {};
  if (fits_in_16_bits(sound)) return {"pcm_s16le", AV_SAMPLE_FMT_S16, true};
  return {"pcm_s24le", AV_SAMPLE_FMT_S32, true};
}

int rate_for(const Target& target, int rate) {
  constexpr std::array kOfAac{96000, 88200, 64000, 48000, 44100, 32000, 24000, 22050, 16000, 12000, 11025, 8000};
  const bool kept =
      target.any_rate || (std::string_view(target.encoder) == "aac" && std::ranges::find(kOfAac, rate) != kOfAac.end());
  return kept ? rate : kEncodedRate;
}

CodecHandle open_sound_decoder(const AVStream& from) {
  const AVCodec* codec = avcodec_find_decoder(from.codecpar->codec_id);
  if (!codec || !is_sound_decoder(*codec)) return nullptr;
  CodecHandle decoder(avcodec_alloc_context3(codec));
  if (!decoder || avcodec_parameters_to_context(decoder.get(), from.codecpar) < 0) return nullptr;
  decoder->pkt_timebase = from.time_base;
  return avcodec_open2(decoder.get(), codec, nullptr) < 0 ? nullptr : std::move(decoder);
}

/// That of the file, and others of so many channels, for codecs that do not have it: Opus knows 3 as 3.0, 4 as quad.
std::vector<AVChannelLayout> layouts_for(const AVChannelLayout& from) {
  const AVChannelLayout surround = AV_CHANNEL_LAYOUT_SURROUND, quad = AV_CHANNEL_LAYOUT_QUAD;
  AVChannelLayout usual{};
  av_channel_layout_default(&usual, from.nb_channels);
  std::vector<AVChannelLayout> all;
  if (from.order != AV_CHANNEL_ORDER_UNSPEC) all.push_back(from);
  all.push_back(usual);
  if (from.nb_channels == 3) all.push_back(surround);
  if (from.nb_channels == 4) all.push_back(quad);
  return all;
}

CodecHandle open_sound_encoder(const AVCodecParameters& from, const AVOutputFormat& format,
                               const AVChannelLayout& layout) {
  const Target target = target_for(format, from);
  const AVCodec* codec = target.encoder ? avcodec_find_encoder_by_name(target.encoder) : nullptr;
  CodecHandle encoder(codec ? avcodec_alloc_context3(codec) : nullptr);
  const int channels = from.ch_layout.nb_channels;
  if (!encoder || from.sample_rate < 1 || channels < 1) return nullptr;
  encoder->sample_fmt = target.format;
  encoder->sample_rate = rate_for(target, from.sample_rate);
  encoder->time_base = {1, encoder->sample_rate};
  if (av_channel_layout_copy(&encoder->ch_layout, &layout) < 0) return nullptr;
  if (!target.any_rate) encoder->bit_rate = std::int64_t{kBitsASecond} * channels;
  encoder->flags |= AV_CODEC_FLAG_BITEXACT;
  if ((format.flags & AVFMT_GLOBALHEADER) != 0) encoder->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  const int code = avcodec_open2(encoder.get(), codec, nullptr);
  static_cast<void>(ffmpeg_said());
  return code < 0 ? nullptr : std::move(encoder);
}

/// Channel by channel where the file does not say what they are. What is low alone is heard in the middle.
const AVChannelLayout& layout_of(const AVFrame& frame, const AVChannelLayout& encoded) {
  const AVChannelLayout low = AV_CHANNEL_LAYOUT_2POINT1, middle = AV_CHANNEL_LAYOUT_SURROUND;
  const AVChannelLayout& given = frame.ch_layout;
  const bool bare = given.order == AV_CHANNEL_ORDER_UNSPEC && given.nb_channels == encoded.nb_channels;
  const bool moved = av_channel_layout_compare(&given, &low) == 0 && av_channel_layout_compare(&encoded, &middle) == 0;
  return bare || moved ? encoded : given;
}

/// From this sample on.
std::array<void*, AV_NUM_DATA_POINTERS> planes_from(const AVFrame& samples, std::int64_t first) {
  const auto format = static_cast<AVSampleFormat>(samples.format);
  const bool planar = av_sample_fmt_is_planar(format) != 0;
  const std::int64_t stride =
      std::int64_t{av_get_bytes_per_sample(format)} * (planar ? 1 : samples.ch_layout.nb_channels);
  std::array<void*, AV_NUM_DATA_POINTERS> planes{};
  for (std::size_t i = 0; i < planes.size() && samples.data[i]; ++i) planes[i] = samples.data[i] + first * stride;
  return planes;
}

}  // namespace

std::unique_ptr<FfmpegSoundEncoder> FfmpegSoundEncoder::open(const AVStream& from, const AVOutputFormat& format) {
  std::unique_ptr<FfmpegSoundEncoder> out(new FfmpegSoundEncoder());
  if (from.codecpar->ch_layout.nb_channels > kMostChannels) return nullptr;
  for (const AVChannelLayout& layout : layouts_for(from.codecpar->ch_layout)) {
    out->encoder_ = open_sound_encoder(*from.codecpar, format, layout);
    if (out->encoder_) break;
  }
  if (!out->encoder_) return nullptr;
  out->decoder_ = open_sound_decoder(from);
  out->frame_.reset(av_frame_alloc());
  const AVCodecContext& encoder = *out->encoder_;
  out->waiting_.reset(av_audio_fifo_alloc(encoder.sample_fmt, encoder.ch_layout.nb_channels, encoder.sample_rate));
  return out->decoder_ && out->frame_ && out->waiting_ ? std::move(out) : nullptr;
}

void FfmpegSoundEncoder::cut(std::int64_t begin, std::int64_t end) {
  begin_ = begin;
  if (end != INT64_MAX) end_ = std::max<std::int64_t>(0, av_rescale_q(end - begin, kMicroseconds, encoder_->time_base));
}

Result<void> FfmpegSoundEncoder::convert(const AVPacket& packet, const Put& put) {
  AFTERGLOW_CHECK(decode(&packet, put));
  return encode(piece(), put);
}

Result<void> FfmpegSoundEncoder::wait(std::int64_t next, std::int64_t until, const Put& put) {
  const std::int64_t rate = encoder_->sample_rate, now = samples_at(until), held = rate / 2;
  if (anchored_ && samples_at(next) - next_ >= kLongestHole * rate) return {};
  // What the decoder and the converter hold, and stamps that are round, come before the packet.
  const std::int64_t late = std::min(samples_at(next) - rate, now - held) - next_;
  return late >= held ? be_silent(late, put) : Result<void>();
}

std::int64_t FfmpegSoundEncoder::samples_at(std::int64_t time) const {
  constexpr std::int64_t kLimit = kFarthestSound * AV_TIME_BASE;
  return av_rescale_q(std::clamp(time, -kLimit, kLimit), kMicroseconds, encoder_->time_base);
}

int FfmpegSoundEncoder::piece() const { return encoder_->frame_size > 0 ? encoder_->frame_size : kSoundPiece; }

Result<void> FfmpegSoundEncoder::finish(const Put& put) {
  AFTERGLOW_CHECK(decode(nullptr, put));
  if (converter_) AFTERGLOW_CHECK(convert_samples(nullptr));
  AFTERGLOW_CHECK(encode(1, put));
  if (const int code = avcodec_send_frame(encoder_.get(), nullptr); code < 0) return encoding_failed(code);
  return drain(put);
}

/// Null: the end.
Result<void> FfmpegSoundEncoder::decode(const AVPacket* packet, const Put& put) {
  avcodec_send_packet(decoder_.get(), packet);  // what it cannot take is silent
  while (avcodec_receive_frame(decoder_.get(), frame_.get()) == 0) {
    auto taken = take(*frame_, put);
    av_frame_unref(frame_.get());
    AFTERGLOW_CHECK(std::move(taken));
  }
  static_cast<void>(ffmpeg_said());
  return {};
}

bool FfmpegSoundEncoder::fits(const AVFrame& frame) {
  const bool same =
      converter_ && frame.sample_rate == rate_ && frame.format == format_ && frame.ch_layout.nb_channels == channels_;
  if (same) return true;
  converter_ = converter_between(frame, layout_of(frame, encoder_->ch_layout), encoder_->ch_layout,
                                 encoder_->sample_fmt, encoder_->sample_rate);
  if (!converter_) return false;
  rate_ = frame.sample_rate;
  format_ = frame.format;
  channels_ = frame.ch_layout.nb_channels;
  return true;
}

Result<void> FfmpegSoundEncoder::take(AVFrame& frame, const Put& put) {
  if (frame.sample_rate < 1 || !fits(frame)) return {};
  if (!hold_samples(frame)) return no_sound_memory();
  AFTERGLOW_CHECK(place(frame, put));
  return convert_samples(&frame);
}

/// Where the frame's samples belong: behind those before, or where its stamp says when that is elsewhere.
Result<void> FfmpegSoundEncoder::place(const AVFrame& frame, const Put& put) {
  if (frame.best_effort_timestamp == AV_NOPTS_VALUE) return {};
  const std::int64_t rate = encoder_->sample_rate;
  const std::int64_t stamp = av_rescale_q(frame.best_effort_timestamp, decoder_->pkt_timebase, encoder_->time_base);
  if (stamp < -kFarthestSound * rate || stamp > kFarthestSound * rate) return {};
  const std::int64_t late = stamp - samples_at(begin_) - next_ - swr_get_delay(converter_.get(), rate);
  if (!std::exchange(anchored_, true)) {
    if (late > 0) return late < kLatestBegin * rate ? be_silent(late, put) : Result<void>();
    if (next_ <= 0) {
      next_ += late;  // what comes before the output's beginning is left out
      return {};
    }
  }
  const bool behind = late > rate / kRoundStamp;
  const bool over = late < -rate / kRoundStamp || (doubled_ > 0 && late < 0);
  doubled_ = over ? -late : 0;
  return behind && late < kLongestHole * rate ? be_silent(late, put) : Result<void>();
}

FrameHandle FfmpegSoundEncoder::room_for(std::int64_t count) const {
  FrameHandle samples(av_frame_alloc());
  if (!samples) return nullptr;
  samples->format = encoder_->sample_fmt;
  samples->sample_rate = encoder_->sample_rate;
  samples->nb_samples = static_cast<int>(count);
  const bool made = av_channel_layout_copy(&samples->ch_layout, &encoder_->ch_layout) >= 0 &&
                    av_frame_get_buffer(samples.get(), 0) >= 0;
  return made ? std::move(samples) : nullptr;
}

/// Null: what the converter still holds.
Result<void> FfmpegSoundEncoder::convert_samples(const AVFrame* frame) {
  const int room = swr_get_out_samples(converter_.get(), frame ? frame->nb_samples : 0);
  if (room <= 0) return {};
  const FrameHandle samples = room_for(room);
  if (!samples) return no_sound_memory();
  const auto** from = frame ? const_cast<const std::uint8_t**>(frame->extended_data) : nullptr;
  const int made = swr_convert(converter_.get(), samples->data, room, from, frame ? frame->nb_samples : 0);
  return add(*samples, std::max(made, 0));
}

/// A second at a time, which is encoded before the next is made.
Result<void> FfmpegSoundEncoder::be_silent(std::int64_t count, const Put& put) {
  doubled_ = 0;
  count = std::min(count, end_ - std::min(next_, end_));
  while (count > 0) {
    const std::int64_t some = std::min<std::int64_t>(count, encoder_->sample_rate);
    const FrameHandle samples = room_for(some);
    if (!samples) return no_sound_memory();
    av_samples_set_silence(samples->data, 0, samples->nb_samples, samples->ch_layout.nb_channels, encoder_->sample_fmt);
    AFTERGLOW_CHECK(add(*samples, some));
    AFTERGLOW_CHECK(encode(piece(), put));
    count -= some;
  }
  return {};
}

/// Those of them that are heard.
Result<void> FfmpegSoundEncoder::add(const AVFrame& samples, std::int64_t count) {
  const std::int64_t doubled = std::min(doubled_, count);
  doubled_ -= doubled;
  const std::int64_t first = std::min(count, doubled + std::max<std::int64_t>(0, -next_)),
                     last = std::min(count, doubled + std::max<std::int64_t>(0, end_ - next_));
  next_ += count - doubled;
  if (first >= last) return {};
  const auto planes = planes_from(samples, first);
  const int some = static_cast<int>(last - first);
  return av_audio_fifo_write(waiting_.get(), const_cast<void**>(planes.data()), some) == some ? Result<void>()
                                                                                              : no_sound_memory();
}

/// As long as so many samples wait.
Result<void> FfmpegSoundEncoder::encode(std::int64_t least, const Put& put) {
  const int most = piece();
  while (av_audio_fifo_size(waiting_.get()) >= least) {
    const int count = std::min(most, av_audio_fifo_size(waiting_.get()));
    const FrameHandle samples = room_for(count);
    if (!samples) return no_sound_memory();
    auto planes = planes_from(*samples, 0);
    if (av_audio_fifo_read(waiting_.get(), planes.data(), count) != count) return no_sound_memory();
    samples->pts = std::exchange(made_, made_ + count);
    if (const int code = avcodec_send_frame(encoder_.get(), samples.get()); code < 0) return encoding_failed(code);
    AFTERGLOW_CHECK(drain(put));
  }
  return {};
}

Result<void> FfmpegSoundEncoder::drain(const Put& put) const {
  while (true) {
    const PacketHandle packet(av_packet_alloc());
    if (!packet) return no_sound_memory();
    const int code = avcodec_receive_packet(encoder_.get(), packet.get());
    if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return {};
    if (code < 0) return encoding_failed(code);
    AFTERGLOW_CHECK(put(*packet));
  }
}

}  // namespace afterglow
