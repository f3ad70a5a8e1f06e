// SPDX-License-Identifier: MIT
#include "image/ffmpeg_opus_delay.h"

#include <cstring>
#include <string_view>

#include "image/ffmpeg_log.h"

namespace afterglow {
namespace {

constexpr int kTrialRate = 48'000, kTrialDelay = kTrialRate / 10;

bool describe_opus(AVStream& stream) {
  constexpr std::string_view kHead("OpusHead\1\1\xC0\x12\x80\xBB\0\0\0\0\0", 19);
  AVCodecParameters& sound = *stream.codecpar;
  stream.time_base = {1, kTrialRate};
  sound.codec_type = AVMEDIA_TYPE_AUDIO;
  sound.codec_id = AV_CODEC_ID_OPUS;
  sound.sample_rate = kTrialRate;
  sound.initial_padding = kTrialDelay;
  av_channel_layout_default(&sound.ch_layout, 1);
  sound.extradata = static_cast<std::uint8_t*>(av_mallocz(kHead.size() + AV_INPUT_BUFFER_PADDING_SIZE));
  if (!sound.extradata) return false;
  std::memcpy(sound.extradata, kHead.data(), kHead.size());
  sound.extradata_size = static_cast<int>(kHead.size());
  return true;
}

/// A packet at one second.
bool write_trial(AVFormatContext& out) {
  AVStream* const stream = avformat_new_stream(&out, nullptr);
  const PacketHandle packet(av_packet_alloc());
  if (!stream || !packet || !describe_opus(*stream) || avio_open_dyn_buf(&out.pb) < 0) return false;
  if (avformat_write_header(&out, nullptr) < 0 || av_new_packet(packet.get(), 4) < 0) return false;
  std::memset(packet->data, 0, 4);
  packet->pts = packet->dts = av_rescale_q(1, {1, 1}, stream->time_base);
  return av_write_frame(&out, packet.get()) >= 0 && av_write_trailer(&out) >= 0;
}

bool adds_delay() {
  AVFormatContext* out = nullptr;
  if (avformat_alloc_output_context2(&out, nullptr, "webm", nullptr) < 0) return true;
  const bool written = write_trial(*out);
  std::uint8_t* bytes = nullptr;
  const int size = out->pb ? avio_close_dyn_buf(out->pb, &bytes) : 0;
  const std::string_view file(reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(size));
  const bool plain = written && file.find("\xE7\x82\x03\xE8") != std::string_view::npos;  // a cluster at 1000 ms
  av_free(bytes);
  out->pb = nullptr;
  avformat_free_context(out);
  static_cast<void>(ffmpeg_said());
  return !plain;
}

}  // namespace

std::int64_t missing_opus_delay(const AVOutputFormat& format, const AVCodecParameters& sound) {
  const std::string_view name = format.name;
  if (sound.codec_id != AV_CODEC_ID_OPUS || (name != "matroska" && name != "webm")) return 0;
  static const bool kAdded = adds_delay();
  return kAdded ? 0 : sound.initial_padding;
}

}  // namespace afterglow
