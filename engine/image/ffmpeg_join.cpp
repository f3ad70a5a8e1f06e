// SPDX-License-Identifier: MIT
#include "image/ffmpeg_join.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <numeric>

#include "core/exception.h"
#include "image/ffmpeg_facts.h"
#include "image/ffmpeg_input.h"
#include "image/ffmpeg_log.h"
#include "image/ffmpeg_video_file.h"

namespace afterglow {
namespace {

/// What all packets share lies beside them; of other codecs, a demuxer may leave there what is no part of the stream.
bool has_header(AVCodecID codec) {
  return codec == AV_CODEC_ID_H264 || codec == AV_CODEC_ID_HEVC || codec == AV_CODEC_ID_AV1 ||
         codec == AV_CODEC_ID_FFV1;
}

bool same_header(const AVCodecParameters& a, const AVCodecParameters& b) {
  if (!has_header(a.codec_id)) return true;
  return a.extradata_size == b.extradata_size &&
         std::memcmp(a.extradata, b.extradata, static_cast<std::size_t>(a.extradata_size)) == 0;
}

/// Why packets of `b` cannot follow those of `a`; empty: they can.
std::string difference(const AVCodecParameters& a, const AVCodecParameters& b) {
  if (a.codec_id != b.codec_id)
    return fmt::format("holds {}, not {}", avcodec_get_name(b.codec_id), avcodec_get_name(a.codec_id));
  if (a.width != b.width || a.height != b.height)
    return fmt::format("has {}x{} pixels, not {}x{}", b.width, b.height, a.width, a.height);
  if (a.format != b.format)
    return fmt::format("has other pixels than the first piece (--pix-fmt says which for all; formats {} and {})",
                       b.format, a.format);
  return same_header(a, b) ? "" : "was encoded by another encoder or with other settings than the first piece";
}

class FfmpegJoin {
 public:
  FfmpegJoin(const VideoPlan& plan, const VideoPieces& pieces) : plan_(plan), pieces_(pieces) {}

  Result<void> join(OutputFile& out, const std::filesystem::path& path, const std::string& name,
                    Diagnostics& diagnostics) {
    AFTERGLOW_TRY(file_, FfmpegVideoFile::open(plan_, out, path));
    for (const VideoPiece& piece : pieces_.pieces) AFTERGLOW_CHECK(look_at(piece));
    if (times_.empty()) return Error{ErrorKind::io, "there is no frame for it"};
    if (const unsigned tag = file_->codec_tag(); tag != 0) parameters_->codec_tag = tag;
    AFTERGLOW_CHECK(file_->begin(*parameters_, alpha_, name, diagnostics));
    for (const VideoPiece& piece : pieces_.pieces) AFTERGLOW_CHECK(copy(piece));
    AFTERGLOW_CHECK(go_on());
    return file_->finish(pieces_.whole, times_.back().pts + times_.back().duration);
  }

 private:
  Result<void> go_on() const {
    const bool stop = pieces_.interrupted && pieces_.interrupted();
    return stop ? Error{ErrorKind::interrupted, "interrupted"} : Result<void>();
  }

  Result<std::unique_ptr<FfmpegInput>> open(const VideoPiece& piece) const {
    AFTERGLOW_CHECK(go_on());
    const bool mov = plan_.container == "mov" || plan_.container == "mp4";
    return FfmpegInput::open(piece.file, mov ? "mov" : "matroska", SizeLimits{}, plan_.patience);
  }

  /// In which order its packets show, and whether they can follow those before.
  Result<void> look_at(const VideoPiece& piece) {
    AFTERGLOW_TRY(const auto input, open(piece));
    AFTERGLOW_CHECK(compare(piece, *input));
    const PacketHandle packet(av_packet_alloc());
    if (!packet) return Error{ErrorKind::io, "there is no memory to join it"};
    std::vector<std::int64_t> stamps;
    int code = 0;
    for (; (code = input->read(*packet)) == 0; av_packet_unref(packet.get())) {
      AFTERGLOW_CHECK(go_on());
      stamps.push_back(packet->pts);
    }
    if (auto reason = input->given_up()) return *std::move(reason);
    if (code != AVERROR_EOF) return Error{ErrorKind::io, "is damaged: " + ffmpeg_error(code), piece.file.string()};
    if (stamps.size() != piece.times.size())
      return Error{ErrorKind::io, fmt::format("has {} frames, not {}", stamps.size(), piece.times.size()),
                   piece.file.string()};
    std::vector<std::size_t> order(stamps.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return stamps[i]; });
    const std::size_t first = times_.size();
    rank_.resize(first + order.size());
    for (std::size_t shown = 0; shown < order.size(); ++shown) {
      rank_[first + order[shown]] = first + shown;
      if (order[shown] > shown) delay_ = std::max(delay_, order[shown] - shown);
    }
    times_.insert(times_.end(), piece.times.begin(), piece.times.end());
    return {};
  }

  Result<void> compare(const VideoPiece& piece, FfmpegInput& input) {
    const AVCodecParameters& found = *input.stream().codecpar;
    if (parameters_) {
      const std::string why = difference(*parameters_, found);
      return why.empty() ? Result<void>() : Error{ErrorKind::io, why, piece.file.string()};
    }
    parameters_.reset(avcodec_parameters_alloc());
    if (!parameters_ || avcodec_parameters_copy(parameters_.get(), &found) < 0)
      return Error{ErrorKind::io, "there is no memory to join it"};
    parameters_->bit_rate = plan_.bitrate;
    if (parameters_->sample_aspect_ratio.num == 0)  // the container says it alone
      parameters_->sample_aspect_ratio = input.stream().sample_aspect_ratio;
    if (!has_header(found.codec_id)) {
      av_freep(&parameters_->extradata);
      parameters_->extradata_size = 0;
    }
    const AVDictionaryEntry* alpha = av_dict_get(input.stream().metadata, "alpha_mode", nullptr, 0);
    alpha_ = alpha && std::strcmp(alpha->value, "1") == 0;
    if (plan_.time_code.empty()) plan_.time_code = first_time_code(input.container());
    return {};
  }

  Result<void> copy(const VideoPiece& piece) {
    AFTERGLOW_TRY(const auto input, open(piece));
    const PacketHandle packet(av_packet_alloc());
    if (!packet) return Error{ErrorKind::io, "there is no memory to join it"};
    for (std::size_t i = 0; i < piece.times.size(); ++i) {
      AFTERGLOW_CHECK(go_on());
      const int code = input->read(*packet);
      if (auto reason = input->given_up()) return *std::move(reason);
      if (code != 0) return Error{ErrorKind::io, "changed while it was read", piece.file.string()};
      const VideoTime& time = times_[rank_[next_]];
      packet->pts = time.pts;
      packet->dts = decoded_at(next_);
      packet->duration = time.duration;
      packet->pos = -1;
      ++next_;
      AFTERGLOW_CHECK(file_->write(*packet));
    }
    return {};
  }

  /// Frames are decoded in their places, as late as all of them are there in time; the first ones before the clock
  /// begins.
  std::int64_t decoded_at(std::size_t place) const {
    if (place >= delay_) return times_[place - delay_].pts;
    const std::int64_t lead = delay_ < times_.size() ? times_[delay_].pts - times_[0].pts
                                                     : times_.back().pts + times_.back().duration - times_[0].pts;
    return times_[std::min(place, times_.size() - 1)].pts - lead;
  }

  VideoPlan plan_;
  const VideoPieces& pieces_;
  std::unique_ptr<FfmpegVideoFile> file_;
  ParametersHandle parameters_;
  bool alpha_ = false;
  std::vector<VideoTime> times_;   ///< of all frames in the order in which they show
  std::vector<std::size_t> rank_;  ///< the frame that each packet makes
  std::size_t delay_ = 0;          ///< places by which a packet may come after the one that shows there
  std::size_t next_ = 0;           ///< packet that is written next
};

}  // namespace

Result<void> join_with_ffmpeg(const VideoPlan& plan, const VideoPieces& pieces, OutputFile& out,
                              const std::filesystem::path& path, const std::string& name, Diagnostics& diagnostics) {
  try {
    return FfmpegJoin(plan, pieces).join(out, path, name, diagnostics);
  } catch (const std::exception& error) {
    return Error{ErrorKind::io, "cannot be joined: " + exception_text(error)};
  }
}

}  // namespace afterglow
