// SPDX-License-Identifier: MIT
#include "image/ffmpeg_encoder.h"

extern "C" {
#include <libavutil/opt.h>
#include <libavutil/pixdesc.h>
}

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <map>

#include "core/large_pages.h"
#include "core/text.h"
#include "image/ffmpeg_log.h"
#include "image/ffmpeg_video_file.h"
#include "image/palette.h"

namespace afterglow {
namespace {

Error encoder_failed(int code) { return {ErrorKind::io, "cannot be encoded: " + ffmpeg_error(code)}; }

class FfmpegEncoder : public VideoEncoder {
 public:
  explicit FfmpegEncoder(const VideoPlan& plan) : plan_(plan) {}

  Result<void> open(OutputFile& out, const std::filesystem::path& path, const std::string& name,
                    Diagnostics& diagnostics) {
    AFTERGLOW_TRY(file_, FfmpegVideoFile::open(plan_, out, path));
    AFTERGLOW_CHECK(open_codec(name));
    ParametersHandle parameters(avcodec_parameters_alloc());
    if (!parameters) return encoder_failed(AVERROR(ENOMEM));
    if (const int code = avcodec_parameters_from_context(parameters.get(), codec_.get()); code < 0)
      return encoder_failed(code);
    return file_->begin(*parameters, plan_.pack.layout->alpha, name, diagnostics);
  }

  Result<void> write(const PackedFrame& frame, VideoTime time) override {
    FrameHandle picture(av_frame_alloc());
    if (!picture) return encoder_failed(AVERROR(ENOMEM));
    picture->format = codec_->pix_fmt;
    picture->width = codec_->width;
    picture->height = codec_->height;
    if (const int code = av_frame_get_buffer(picture.get(), 0); code < 0) return encoder_failed(code);
    if (is_palette()) {
      copy_palette(palette_picture(frame), *picture);
    } else {
      copy_planes(frame, *picture);
    }
    picture->pts = time.pts;
    picture->colorspace = codec_->colorspace;
    picture->color_primaries = codec_->color_primaries;
    picture->color_trc = codec_->color_trc;
    picture->color_range = codec_->color_range;
    picture->chroma_location = codec_->chroma_sample_location;
    picture->sample_aspect_ratio = rational(plan_.pixel_aspect);
    durations_[time.pts] = time.duration;
    end_ = std::max<std::int64_t>(end_, time.pts + time.duration);
    if (const int code = avcodec_send_frame(codec_.get(), picture.get()); code < 0) return encoder_failed(code);
    return drain();
  }

  Result<void> finish(bool whole) override {
    if (const int code = avcodec_send_frame(codec_.get(), nullptr); code < 0) return encoder_failed(code);
    AFTERGLOW_CHECK(drain());
    return file_->finish(whole, end_);
  }

 private:
  bool is_palette() const { return plan_.container == "gif"; }
  static void copy_planes(const PackedFrame& frame, AVFrame& picture) {
    for (std::size_t plane = 0; plane < frame.planes.size(); ++plane) {
      const auto& from = frame.planes[plane];
      for (int y = 0; y < from.rows; ++y)
        std::memcpy(picture.data[plane] + static_cast<std::ptrdiff_t>(picture.linesize[plane]) * y,
                    frame.bytes.data() + from.offset + from.stride * static_cast<std::size_t>(y), from.stride);
    }
  }
  static void copy_palette(const PalettePicture& from, AVFrame& picture) {
    const auto width = static_cast<std::size_t>(picture.width);
    for (int y = 0; y < picture.height; ++y)
      std::memcpy(picture.data[0] + static_cast<std::ptrdiff_t>(picture.linesize[0]) * y,
                  from.indices.data() + width * static_cast<std::size_t>(y), width);
    std::memcpy(picture.data[1], from.colors.data(), sizeof(from.colors));
  }

  Result<void> open_codec(const std::string& name) {
    const AVCodec* codec = nullptr;
    for (const auto& one : plan_.encoders)
      if (!codec) codec = avcodec_find_encoder_by_name(one.c_str());
    if (!codec)
      return Error{ErrorKind::usage, fmt::format("this FFmpeg has no encoder {}", join(plan_.encoders)), name};
    codec_.reset(avcodec_alloc_context3(codec));
    if (!codec_) return encoder_failed(AVERROR(ENOMEM));
    codec_->width = plan_.size.width;
    codec_->height = plan_.size.height;
    codec_->pix_fmt = is_palette() ? AV_PIX_FMT_PAL8 : av_get_pix_fmt(plan_.pack.layout->name);
    codec_->time_base = rational(plan_.time_base);
    codec_->framerate = rational(plan_.rate);
    codec_->sample_aspect_ratio = rational(plan_.pixel_aspect);
    codec_->bit_rate = plan_.bitrate;
    codec_->thread_count = 0;
    use_small_pages();
    describe_colors();
    codec_->flags |= AV_CODEC_FLAG_BITEXACT;
    if (file_->wants_global_header()) codec_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    if (const unsigned tag = file_->codec_tag(); tag != 0) codec_->codec_tag = tag;
    AVDictionary* options = nullptr;
    for (const auto& [key, value] : plan_.settings) av_dict_set(&options, key.c_str(), value.c_str(), 0);
    add_settings_of(codec->name, &options);
    const int code = avcodec_open2(codec_.get(), codec, &options);
    av_dict_free(&options);
    if (code < 0)
      return Error{ErrorKind::usage,
                   fmt::format("{} does not take {}x{} pixels as {}: {}", codec->name, plan_.size.width,
                               plan_.size.height, plan_.pack.layout->name, ffmpeg_error(code)),
                   name};
    return {};
  }

  /// Quality of constant quality, and what each wrapper calls its effort.
  void add_settings_of(const std::string& encoder, AVDictionary** options) {
    if (encoder == "libsvtav1") {
      setenv("SVT_LOG", "1", 0);  // errors alone: the library writes to stderr itself
      av_dict_set(options, "preset", "8", 0);
    } else if (encoder == "libaom-av1") {
      av_dict_set(options, "cpu-used", "6", 0);
      av_dict_set(options, "row-mt", "1", 0);
    } else if (encoder == "libvpx-vp9" && plan_.pack.layout->alpha) {
      av_dict_set(options, "auto-alt-ref", "0", 0);  // the two streams of colour and alpha must have the same frames
    }
  }

  void describe_colors() {
    if (plan_.container == "gif" || plan_.container == "apng") return;
    codec_->color_primaries = static_cast<AVColorPrimaries>(plan_.primaries);
    codec_->color_trc = static_cast<AVColorTransferCharacteristic>(plan_.transfer);
    codec_->colorspace = static_cast<AVColorSpace>(plan_.matrix);
    const bool rgb = plan_.pack.layout->rgb_colors();
    codec_->color_range = rgb ? AVCOL_RANGE_JPEG : AVCOL_RANGE_MPEG;
    if (!rgb && plan_.pack.layout->chroma_x > 0) codec_->chroma_sample_location = AVCHROMA_LOC_LEFT;
  }

  /// Packets that are ready.
  Result<void> drain() {
    while (true) {
      PacketHandle packet(av_packet_alloc());
      if (!packet) return encoder_failed(AVERROR(ENOMEM));
      const int code = avcodec_receive_packet(codec_.get(), packet.get());
      if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return {};
      if (code < 0) return encoder_failed(code);
      if (const auto found = durations_.find(packet->pts); found != durations_.end()) {
        packet->duration = found->second;
        durations_.erase(found);
      }
      say_matrix(*packet);
      AFTERGLOW_CHECK(file_->write(*packet));
    }
  }

  /// The colour volume of a frame of DNxHR (SMPTE ST 2019-1), which libavcodec writes as that of BT.709: two bits, of
  /// which 1 is BT.2020.
  void say_matrix(AVPacket& packet) const {
    constexpr int kAt = 0x2c, kVolume = 6, kBt2020 = 2, kMatrix = 9;
    if (plan_.codec != "dnxhr" || plan_.matrix != kMatrix || packet.size <= kAt) return;
    packet.data[kAt] = static_cast<std::uint8_t>((packet.data[kAt] & ~kVolume) | kBt2020);
  }

  VideoPlan plan_;
  std::unique_ptr<FfmpegVideoFile> file_;
  CodecHandle codec_;
  std::map<std::int64_t, std::int64_t> durations_;  ///< of frames whose packets have not come, by time
  std::int64_t end_ = 0;
};

}  // namespace

bool has_ffmpeg_encoder(const std::string& name) { return avcodec_find_encoder_by_name(name.c_str()) != nullptr; }

Result<std::unique_ptr<VideoEncoder>> encode_with_ffmpeg(const VideoPlan& plan, OutputFile& out,
                                                         const std::filesystem::path& path, const std::string& name,
                                                         Diagnostics& diagnostics) {
  auto encoder = std::make_unique<FfmpegEncoder>(plan);
  AFTERGLOW_CHECK(encoder->open(out, path, name, diagnostics));
  return std::unique_ptr<VideoEncoder>(std::move(encoder));
}

}  // namespace afterglow
