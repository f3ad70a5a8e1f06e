// SPDX-License-Identifier: MIT
#include "image/ffmpeg_video_file.h"

extern "C" {
#include <libavutil/opt.h>
}

#include <algorithm>
#include <limits>

#include "image/ffmpeg_log.h"
#include "image/time_code.h"

namespace afterglow {
namespace {

Error stream_failed(int code) { return {ErrorKind::io, "cannot be written: " + ffmpeg_error(code)}; }

}  // namespace

Result<std::unique_ptr<FfmpegVideoFile>> FfmpegVideoFile::open(const VideoPlan& plan, OutputFile& out,
                                                               const std::filesystem::path& path) {
  std::unique_ptr<FfmpegVideoFile> file(new FfmpegVideoFile(plan));
  AFTERGLOW_TRY(file->output_, FfmpegOutput::open(plan.container.c_str(), out, path));
  return file;
}

bool FfmpegVideoFile::wants_global_header() const {
  return (output_->container().oformat->flags & AVFMT_GLOBALHEADER) != 0;
}

unsigned FfmpegVideoFile::codec_tag() const {
  return plan_.codec == "h265" && plan_.container != "matroska" ? MKTAG('h', 'v', 'c', '1') : 0;
}

Result<void> FfmpegVideoFile::begin(const AVCodecParameters& frames, bool alpha, const std::string& name,
                                    Diagnostics& diagnostics) {
  stream_ = avformat_new_stream(&output_->container(), nullptr);
  if (!stream_) return stream_failed(AVERROR(ENOMEM));
  if (const int code = avcodec_parameters_copy(stream_->codecpar, &frames); code < 0) return stream_failed(code);
  stream_->time_base = rational(plan_.time_base);
  stream_->avg_frame_rate = rational(plan_.rate);
  const AVRational aspect = frames.sample_aspect_ratio;
  stream_->sample_aspect_ratio = stream_->codecpar->sample_aspect_ratio = aspect.num > 0 ? aspect : AVRational{1, 1};
  if (plan_.codec == "vp9" && alpha) av_dict_set(&stream_->metadata, "alpha_mode", "1", 0);
  AFTERGLOW_CHECK(add_copies(name, diagnostics));
  add_time_code();
  return write_head();
}

Result<void> FfmpegVideoFile::add_copies(const std::string& name, Diagnostics& diagnostics) {
  const bool sound_only = !plan_.audio.empty();
  const auto& from = sound_only ? plan_.audio : plan_.source;
  if (from.empty()) return {};
  const CopyRange& range = sound_only ? plan_.audio_range : plan_.range;
  const Copied what = sound_only ? Copied::sound : plan_.silent ? Copied::all_but_sound : Copied::all;
  AFTERGLOW_TRY(copy_,
                FfmpegCopy::open(from, what, !plan_.copies_only, *output_, range, plan_.patience, name, diagnostics));
  if (!sound_only) copy_->describe_pictures(*stream_);
  return {};
}

/// That of the first picture that is written.
void FfmpegVideoFile::add_time_code() {
  const bool from_source = plan_.time_code.empty() && copy_ && plan_.audio.empty();
  const std::string text = from_source ? copy_->time_code() : plan_.time_code;
  const AVRational rate = rational(plan_.rate);
  const bool later = from_source && plan_.range.begin >= 0;
  const long long frames =
      later ? av_rescale_q(std::max(0LL, plan_.audio_range.shift), kMicroseconds, av_inv_q(rate)) : 0;
  const std::string first = time_code_after(text, frames, plan_.rate);
  if (first.empty()) return;
  av_dict_set(&output_->container().metadata, "timecode", nullptr, 0);
  av_dict_set(&stream_->metadata, "timecode", first.c_str(), 0);
}

Result<void> FfmpegVideoFile::write_head() {
  AVDictionary* options = nullptr;
  if (plan_.container == "mp4") av_dict_set(&options, "movflags", "+faststart+write_colr", 0);
  if (plan_.container == "mov") av_dict_set(&options, "movflags", "+write_colr", 0);
  if (plan_.container == "apng") av_dict_set(&options, "plays", "0", 0);
  auto begun = output_->begin(&options);
  av_dict_free(&options);
  return begun;
}

Result<void> FfmpegVideoFile::write(AVPacket& packet) {
  const AVRational clock = rational(plan_.time_base);
  if (copy_) AFTERGLOW_CHECK(copy_->copy(av_rescale_q(packet.dts, clock, kMicroseconds)));
  last_ = std::max(last_, packet.pts);
  av_packet_rescale_ts(&packet, clock, stream_->time_base);
  packet.stream_index = stream_->index;
  return output_->write(packet);
}

/// The muxers of GIF and APNG repeat the length before the last one, unless they are told.
void FfmpegVideoFile::say_last_length(std::int64_t ticks) {
  constexpr int kLargest = 65535;
  const AVRational clock = rational(plan_.time_base);
  void* const muxer = output_->container().priv_data;
  if (plan_.container == "gif") {
    const std::int64_t hundredths = av_rescale_q(ticks, clock, {1, 100});
    av_opt_set_int(muxer, "final_delay", std::clamp<std::int64_t>(hundredths, 0, kLargest), 0);
  }
  if (plan_.container == "apng") {
    AVRational length{};
    av_reduce(&length.num, &length.den, ticks * clock.num, clock.den, kLargest);
    av_opt_set_q(muxer, "final_delay", length, 0);
  }
}

Result<void> FfmpegVideoFile::finish(bool whole, std::int64_t end) {
  const std::int64_t until = av_rescale_q(end, rational(plan_.time_base), kMicroseconds);
  if (copy_) AFTERGLOW_CHECK(copy_->copy(whole ? std::numeric_limits<std::int64_t>::max() : until));
  if (copy_) AFTERGLOW_CHECK(copy_->finish());
  say_last_length(end - last_);
  return output_->finish();
}

}  // namespace afterglow
