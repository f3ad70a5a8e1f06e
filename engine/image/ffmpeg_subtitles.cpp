// SPDX-License-Identifier: MIT
#include "image/ffmpeg_subtitles.h"

extern "C" {
#include <libavutil/mem.h>
}

#include <cstring>
#include <string_view>

namespace afterglow {
namespace {

constexpr std::size_t kLargest = 1u << 20;  // bytes of one subtitle

bool is_text(AVCodecID codec) {
  const AVCodecDescriptor* descriptor = avcodec_descriptor_get(codec);
  return descriptor && (descriptor->props & AV_CODEC_PROP_TEXT_SUB) != 0;
}

CodecHandle open_text_decoder(const AVStream& from) {
  const AVCodec* codec = avcodec_find_decoder(from.codecpar->codec_id);
  CodecHandle decoder(codec ? avcodec_alloc_context3(codec) : nullptr);
  if (!decoder || avcodec_parameters_to_context(decoder.get(), from.codecpar) < 0) return nullptr;
  decoder->pkt_timebase = from.time_base;
  return avcodec_open2(decoder.get(), codec, nullptr) < 0 ? nullptr : std::move(decoder);
}

/// `decoder` says how texts look.
CodecHandle open_text_encoder(AVCodecID id, const AVCodecContext& decoder) {
  const AVCodec* codec = avcodec_find_encoder(id);
  CodecHandle encoder(codec ? avcodec_alloc_context3(codec) : nullptr);
  if (!encoder) return nullptr;
  encoder->time_base = {1, 1000};
  encoder->flags |= AV_CODEC_FLAG_GLOBAL_HEADER | AV_CODEC_FLAG_BITEXACT;
  if (decoder.subtitle_header_size > 0) {
    const auto size = static_cast<std::size_t>(decoder.subtitle_header_size);
    encoder->subtitle_header = static_cast<std::uint8_t*>(av_mallocz(size + 1));  // text: it ends with a zero
    if (!encoder->subtitle_header) return nullptr;
    std::memcpy(encoder->subtitle_header, decoder.subtitle_header, size);
    encoder->subtitle_header_size = decoder.subtitle_header_size;
  }
  return avcodec_open2(encoder.get(), codec, nullptr) < 0 ? nullptr : std::move(encoder);
}

/// Freed with it.
struct Subtitle : AVSubtitle {
  Subtitle() : AVSubtitle{} {}
  ~Subtitle() { avsubtitle_free(this); }
  Subtitle(const Subtitle&) = delete;
  Subtitle& operator=(const Subtitle&) = delete;
};

}  // namespace

AVCodecID FfmpegSubtitles::codec_for(const AVOutputFormat& format) {
  const std::string_view name = format.name;
  if (name == "mp4" || name == "mov") return AV_CODEC_ID_MOV_TEXT;
  if (name == "matroska") return AV_CODEC_ID_ASS;
  return name == "webm" ? AV_CODEC_ID_WEBVTT : AV_CODEC_ID_NONE;
}

std::unique_ptr<FfmpegSubtitles> FfmpegSubtitles::open(const AVStream& from, const AVOutputFormat& format) {
  const AVCodecID to = codec_for(format);
  if (to == AV_CODEC_ID_NONE || !is_text(from.codecpar->codec_id)) return nullptr;
  std::unique_ptr<FfmpegSubtitles> out(new FfmpegSubtitles());
  out->decoder_ = open_text_decoder(from);
  if (!out->decoder_) return nullptr;
  out->encoder_ = open_text_encoder(to, *out->decoder_);
  if (!out->encoder_) return nullptr;
  out->text_.resize(kLargest);
  return out;
}

bool FfmpegSubtitles::convert(AVPacket& packet) {
  Subtitle subtitle;
  int shows = 0;
  if (avcodec_decode_subtitle2(decoder_.get(), &subtitle, &shows, &packet) < 0 || shows == 0) return false;
  if (subtitle.num_rects == 0) return false;
  const int size = avcodec_encode_subtitle(encoder_.get(), text_.data(), static_cast<int>(text_.size()), &subtitle);
  if (size <= 0) return false;
  const PacketHandle made(av_packet_alloc());
  if (!made || av_new_packet(made.get(), size) < 0 || av_packet_copy_props(made.get(), &packet) < 0) return false;
  av_packet_free_side_data(made.get());
  std::memcpy(made->data, text_.data(), static_cast<std::size_t>(size));
  av_packet_unref(&packet);
  av_packet_move_ref(&packet, made.get());
  return true;
}

}  // namespace afterglow
