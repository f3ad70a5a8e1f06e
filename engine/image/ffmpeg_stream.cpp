// SPDX-License-Identifier: MIT
#include "image/ffmpeg_stream.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "image/ffmpeg_clock.h"
#include "image/ffmpeg_facts.h"
#include "image/ffmpeg_input.h"
#include "image/movie_color.h"
#include "image/time_code.h"

namespace afterglow {
namespace {

/// JPEGs one behind the other: FFmpeg makes a picture of one that is cut off, too.
bool is_cut_jpeg(const AVFormatContext& container, const AVPacket& packet) {
  const std::string_view bytes(reinterpret_cast<const char*>(packet.data), static_cast<std::size_t>(packet.size));
  return std::string_view(container.iformat->name) == "mjpeg" && bytes.rfind("\xff\xd9") == std::string_view::npos;
}

/// One decoded frame.
class StreamFrame : public MovieSource {
 public:
  StreamFrame(FrameHandle frame, MovieFacts facts, std::shared_ptr<FfmpegPlanes> planes)
      : frame_(std::move(frame)), planes_(std::move(planes)) {
    facts_ = std::move(facts);
  }
  Result<void> read(int, float* rgba, std::size_t row_stride) override {
    return planes_->convert(*frame_, planes_of(*frame_, facts_), rgba, row_stride);
  }

 private:
  FrameHandle frame_;
  std::shared_ptr<FfmpegPlanes> planes_;
};

constexpr const char* kCut = "is cut off: the stream ends in it";
constexpr const char* kAnew = "comes near a place where the stream's clock starts anew, which is read of files only";

class FfmpegStream : public MovieFrames {
 public:
  Result<void> open(const StreamRequest& request) {
    AFTERGLOW_TRY(input_, FfmpegInput::open(request));
    AFTERGLOW_TRY(codec_, input_->open_decoder(errors_, true));
    name_ = request.name;
    return {};
  }

  Result<std::shared_ptr<MovieSource>> next() override {
    while (true) {
      FrameHandle frame(av_frame_alloc());
      const int got = avcodec_receive_frame(codec_.get(), frame.get());
      if (got == 0) return made(std::move(frame));
      if (got != AVERROR_EOF && got != AVERROR(EAGAIN) && !draining_) return broken("is damaged");
      if ((got == AVERROR_EOF || draining_) && cut_) return broken(kCut);
      if (got == AVERROR_EOF || draining_) return std::shared_ptr<MovieSource>();
      AFTERGLOW_CHECK(feed());
    }
  }

 private:
  Error broken(const std::string& why) const {
    return {ErrorKind::io, fmt::format("frame {} {}", count_ + 1, why), name_};
  }

  /// Whether the packet that looks cut does so for being the last one before the clock starts anew, or the one before.
  bool ends_part() {
    if (!is_mpeg(input_->container())) return false;
    for (int ahead = 0; ahead < 2; ++ahead) {
      const std::int64_t last = packet_->dts;
      if (input_->read(*packet_) < 0) return false;
      if (starts_anew(last, packet_->dts, input_->stream().time_base)) return true;
    }
    return false;
  }

  Result<void> feed() {
    const int read = input_->read(*packet_);
    if (read == AVERROR_EOF && !input_->given_up()) {
      draining_ = true;
      cut_ = input_->ends_early();
      avcodec_send_packet(codec_.get(), nullptr);
      return {};
    }
    if (auto reason = input_->given_up()) return *std::move(reason);
    if (read < 0) return broken(kCut);
    if (is_cut_jpeg(input_->container(), *packet_)) return broken(kCut);
    if ((packet_->flags & AV_PKT_FLAG_CORRUPT) != 0) return broken(ends_part() ? kAnew : kCut);
    const int sent = avcodec_send_packet(codec_.get(), packet_.get());
    av_packet_unref(packet_.get());
    return sent < 0 ? Result<void>(broken("is cut off or damaged: " + ffmpeg_error(sent))) : Result<void>();
  }

  Result<std::shared_ptr<MovieSource>> made(FrameHandle frame) {
    if (frame->decode_error_flags != 0 || (frame->flags & AV_FRAME_FLAG_CORRUPT) != 0) return broken("is damaged");
    if (count_ == 0) {
      facts_ = facts_of(*input_, *frame);
      const AVFormatContext& container = input_->container();
      for (unsigned i = 0; i < container.nb_streams; ++i)
        if (container.streams[i]->codecpar->codec_type == AVMEDIA_TYPE_AUDIO) facts_.sound = true;
      if (const auto filled = fill_in(facts_); !filled) return broken(filled.error().message);
    }
    if (frame->width != facts_.stored.width || frame->height != facts_.stored.height)
      return broken(fmt::format("is {}x{} in a stream of {}x{}", frame->width, frame->height, facts_.stored.width,
                                facts_.stored.height));
    MovieFacts facts = facts_;
    const bool timed = frame->best_effort_timestamp != AV_NOPTS_VALUE;
    facts.pts = {timed ? frame->best_effort_timestamp : count_};
    facts.time_code = time_code_after(facts_.time_code, count_, facts_.rate);
    ++count_;
    return std::shared_ptr<MovieSource>(std::make_shared<StreamFrame>(std::move(frame), std::move(facts), planes_));
  }

  std::string name_;
  FfmpegErrors errors_ = 0;
  std::unique_ptr<FfmpegInput> input_;
  CodecHandle codec_;
  PacketHandle packet_{av_packet_alloc()};
  std::shared_ptr<FfmpegPlanes> planes_ = std::make_shared<FfmpegPlanes>();
  MovieFacts facts_;
  long long count_ = 0;
  bool draining_ = false, cut_ = false;
};

}  // namespace

Result<std::unique_ptr<MovieFrames>> stream_with_ffmpeg(const StreamRequest& request) {
  auto stream = std::make_unique<FfmpegStream>();
  AFTERGLOW_CHECK(stream->open(request));
  return std::unique_ptr<MovieFrames>(std::move(stream));
}

}  // namespace afterglow
