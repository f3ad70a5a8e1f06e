// SPDX-License-Identifier: MIT
#include "image/ffmpeg_input.h"

extern "C" {
#include <libavutil/opt.h>
#include <libavutil/pixdesc.h>
}

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <thread>

#include "image/ffmpeg_log.h"

namespace afterglow {
namespace {

/// Decoders that strangers' files may reach: the ones people use, each fuzzed by FFmpeg's own project for years.
constexpr const char* kCodecs =
    "h264,hevc,vp8,vp9,libvpx,libvpx-vp9,libdav1d,libaom-av1,av1,prores,dnxhd,ffv1,mjpeg,gif,apng,png,mpeg1video,"
    "mpeg2video,mpeg4,rawvideo,wrapped_avframe,v210,v410,r210,cfhd,huffyuv,ffvhuff,utvideo,qtrle,theora,dvvideo,"
    "jpeg2000,tiff,bmp,ppm,pgm,pam,pfm,hap,magicyuv";

/// Native decoders of FFmpeg know nothing of VP8's and VP9's second stream of alpha.
const AVCodec* decoder_of(const AVStream& stream) {
  const AVDictionaryEntry* alpha = av_dict_get(stream.metadata, "alpha_mode", nullptr, 0);
  if (alpha && std::strcmp(alpha->value, "1") == 0) {
    const char* name = stream.codecpar->codec_id == AV_CODEC_ID_VP9   ? "libvpx-vp9"
                       : stream.codecpar->codec_id == AV_CODEC_ID_VP8 ? "libvpx"
                                                                      : nullptr;
    if (const AVCodec* found = name ? avcodec_find_decoder_by_name(name) : nullptr) return found;
  }
  return avcodec_find_decoder(stream.codecpar->codec_id);
}

}  // namespace

bool is_among(const AVCodec& codec, const std::string& names) {
  return ("," + names + ",").find(std::string(",") + codec.name + ",") != std::string::npos;
}

std::optional<Error> FfmpegInput::given_up() const {
  std::optional<Error> out = bytes_->given_up();
  if (out) out->file = name_;
  return out;
}

bool FfmpegInput::ends_early() {
  return remarks_.ends_early || (bytes_->end_is_known() && afterglow::ends_early(format_, bytes_->again(), last_));
}

FfmpegInput::~FfmpegInput() {
  if (container_) avformat_close_input(&container_);
}

Error FfmpegInput::failed(const std::string& why) const {
  if (auto reason = given_up()) return *std::move(reason);
  return {ErrorKind::io, why, name_};
}

Result<std::unique_ptr<FfmpegInput>> FfmpegInput::open(const std::filesystem::path& file, const std::string& format,
                                                       const SizeLimits& limits, const Patience& patience) {
  AFTERGLOW_TRY(auto bytes, FfmpegBytes::open(file, patience));
  return open(std::move(bytes), file.string(), format, limits, {});
}

Result<std::unique_ptr<FfmpegInput>> FfmpegInput::open(const StreamRequest& request) {
  auto reader = std::make_unique<PatientReader>(request.from, request.patience, request.cancelled);
  return open(std::make_unique<FfmpegBytes>(std::move(reader), request.head, request.limits.max_bytes), request.name,
              request.format, request.limits, request.options);
}

Result<std::unique_ptr<FfmpegInput>> FfmpegInput::open(std::unique_ptr<FfmpegBytes> bytes, const std::string& name,
                                                       const std::string& format, const SizeLimits& limits,
                                                       const std::string& options) {
  std::unique_ptr<FfmpegInput> input(new FfmpegInput());
  input->name_ = name;
  input->format_ = format;
  input->limits_ = limits;
  input->bytes_ = std::move(bytes);
  static_cast<void>(ffmpeg_said());
  AFTERGLOW_CHECK(input->open_container(format, options));
  AFTERGLOW_CHECK(input->choose_stream());
  return input;
}

Result<void> FfmpegInput::open_container(const std::string& format, const std::string& options) {
  const AVInputFormat* demuxer = av_find_input_format(format.c_str());
  if (!demuxer) return failed(fmt::format("FFmpeg {} cannot read '{}' files", av_version_info(), format));
  container_ = bytes_->container();
  if (!container_) return failed("there is no memory to open it");
  container_->max_streams = 64;
  container_->opaque = &remarks_;
  container_->codec_whitelist = av_strdup(kCodecs);
  AVDictionary* given = nullptr;
  av_dict_parse_string(&given, options.c_str(), "=", ":", 0);
  const int opened = avformat_open_input(&container_, "", demuxer, &given);  // frees the container when it fails
  const bool unknown = opened >= 0 && av_dict_count(given) > 0;
  av_dict_free(&given);
  if (opened < 0) return failed("is no video that can be read: " + ffmpeg_error(opened));
  bytes_->packet_came();
  if (unknown) return failed("is of a kind that has no such options: " + options);
  return {};
}

/// AVIF and HEIF with a track of pictures: another track of theirs is the alpha of the first.
bool FfmpegInput::is_picture_sequence() const {
  const AVDictionaryEntry* brand = av_dict_get(container_->metadata, "major_brand", nullptr, 0);
  return brand && (std::strcmp(brand->value, "avis") == 0 || std::strcmp(brand->value, "msf1") == 0);
}

int FfmpegInput::first_pictures() const {
  for (unsigned i = 0; i < container_->nb_streams; ++i)
    if (container_->streams[i]->codecpar->codec_type == AVMEDIA_TYPE_VIDEO) return static_cast<int>(i);
  return -1;
}

bool FfmpegInput::leaves_alpha() const {
  if (!is_picture_sequence()) return false;
  for (unsigned i = 0; i < container_->nb_streams; ++i) {
    const AVCodecParameters& other = *container_->streams[i]->codecpar;
    const AVPixFmtDescriptor* format = av_pix_fmt_desc_get(static_cast<AVPixelFormat>(other.format));
    if (static_cast<int>(i) != stream_ && other.codec_type == AVMEDIA_TYPE_VIDEO && format &&
        format->nb_components == 1)
      return true;
  }
  return false;
}

SaidColor FfmpegInput::said_around() const {
  const auto at = static_cast<std::size_t>(stream_);
  return at < said_.size() ? said_[at] : SaidColor{};
}

Result<void> FfmpegInput::choose_stream() {
  // Looking into streams writes what their decoders say over what the container says.
  for (unsigned i = 0; i < container_->nb_streams; ++i) said_.push_back(said_by(*container_->streams[i]->codecpar));
  // The best is chosen twice: most containers name their streams first, others must be looked into.
  for (unsigned i = 0; i < container_->nb_streams; ++i)
    if (container_->streams[i]->codecpar->codec_type != AVMEDIA_TYPE_VIDEO)
      container_->streams[i]->discard = AVDISCARD_ALL;
  if (const int found = avformat_find_stream_info(container_, nullptr); found < 0)
    return failed("is no video that can be read: " + ffmpeg_error(found));
  if (bytes_->given_up()) return failed("");
  stream_ = is_picture_sequence() ? first_pictures()
                                  : av_find_best_stream(container_, AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
  if (stream_ < 0) return failed("holds no video stream");
  for (unsigned i = 0; i < container_->nb_streams; ++i)
    container_->streams[i]->discard = static_cast<int>(i) == stream_ ? AVDISCARD_DEFAULT : AVDISCARD_ALL;
  const AVCodecParameters& parameters = *stream().codecpar;
  codec_ = decoder_of(stream());
  if (!codec_ || !is_among(*codec_, kCodecs))
    return failed(fmt::format("is a video whose codec is not read ({})", avcodec_get_name(parameters.codec_id)));
  if (parameters.width < 1 || parameters.height < 1)
    return failed("is a video that does not say how large it is (truncated?)");
  return check_sides({0, 0, parameters.width, parameters.height}, "frame", limits_, name_);
}

Result<CodecHandle> FfmpegInput::open_decoder(FfmpegErrors& errors, bool careful) const {
  const AVStream& stream = *container_->streams[stream_];
  CodecHandle codec(avcodec_alloc_context3(codec_));
  if (!codec || avcodec_parameters_to_context(codec.get(), stream.codecpar) < 0)
    return failed("there is no memory to decode it");
  codec->pkt_timebase = stream.time_base;
  constexpr unsigned kMostThreads = 4;  // each holds pictures of its own
  codec->thread_count =
      careful ? 1 : static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1u, kMostThreads));
  // Decoders of single pictures tell of damage by messages and by checksums.
  codec->opaque = &errors;
  const AVCodecDescriptor* kind = avcodec_descriptor_get(codec->codec_id);
  if (kind && (kind->props & AV_CODEC_PROP_INTRA_ONLY) != 0) codec->thread_type = FF_THREAD_SLICE;
  codec->err_recognition = AV_EF_CRCCHECK;
  if (codec->codec_id == AV_CODEC_ID_FFV1 || codec->codec_id == AV_CODEC_ID_APNG || codec->codec_id == AV_CODEC_ID_PNG)
    codec->err_recognition |= AV_EF_EXPLODE;
  // Whether a frame has what it is built on is known from the index, not guessed from the stream.
  codec->flags |= AV_CODEC_FLAG_OUTPUT_CORRUPT;
  const auto side = static_cast<std::int64_t>(limits_.max_side);
  codec->max_pixels = std::min(side * side, static_cast<std::int64_t>(limits_.max_bytes / 4));
  if (const int opened = avcodec_open2(codec.get(), codec_, nullptr); opened < 0)
    return failed("cannot be decoded: " + ffmpeg_error(opened));
  return codec;
}

int FfmpegInput::read(AVPacket& packet, int stream) {
  while (true) {
    av_packet_unref(&packet);  // av_read_frame writes over what it holds
    const int got = av_read_frame(container_, &packet);
    if (got < 0) return got;
    if (packet.pos >= 0)
      last_ = std::max(last_, static_cast<std::uint64_t>(packet.pos) + static_cast<unsigned>(packet.size));
    // Empty packets are frames that an encoder left out; to a decoder they would be the end.
    if (packet.stream_index == stream && packet.size > 0) {
      bytes_->packet_came();
      return 0;
    }
  }
}

}  // namespace afterglow
