// SPDX-License-Identifier: MIT
#include "image/ffmpeg_movie.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <utility>

#include "core/exception.h"
#include "image/ffmpeg_decoder.h"
#include "image/ffmpeg_facts.h"
#include "image/ffmpeg_log.h"
#include "image/movie_color.h"

namespace afterglow {
namespace {

class FfmpegMovie : public MovieSource {
 public:
  Result<void> open(const MovieRequest& request) {
    request_ = request;
    AFTERGLOW_TRY(auto input, reopen(request));
    AFTERGLOW_TRY(index_, index_movie(*input));
    if (needs_order()) {
      AFTERGLOW_CHECK(order_frames(std::move(input)));
    } else {
      begin(std::move(input));
    }
    return look_at_first();
  }

  Result<void> read(int frame, float* rgba, std::size_t row_stride) override {
    const auto number = static_cast<std::size_t>(frame);
    if (number >= index_.order.size()) return Error{ErrorKind::io, "is missing: the file ends before it"};
    FrameHandle decoded;
    {
      const std::lock_guard lock(mutex_);
      AFTERGLOW_TRY(decoded, decoder_->frame(frame));
    }
    if (decoded->width != facts_.stored.width || decoded->height != facts_.stored.height)
      return Error{ErrorKind::io, fmt::format("is {}x{} in a video of {}x{}", decoded->width, decoded->height,
                                              facts_.stored.width, facts_.stored.height)};
    return planes_.convert(*decoded, planes_of(*decoded, facts_), rgba, row_stride);
  }

 private:
  static Result<std::unique_ptr<FfmpegInput>> reopen(const MovieRequest& request) {
    return FfmpegInput::open(request.file, request.format, request.limits, request.patience);
  }

  void begin(std::unique_ptr<FfmpegInput> input) {
    const std::uint64_t cache = movie_cache_bytes(request_.limits.max_bytes);
    decoder_ = std::make_unique<FfmpegDecoder>(
        FfmpegPackets(std::move(input), index_, [request = request_] { return reopen(request); }), index_, cache);
  }

  /// Raw streams and AVI say when packets are decoded and not when frames show.
  bool needs_order() const {
    return std::ranges::any_of(index_.packets, [](const MoviePacket& p) { return p.shown && p.pts == AV_NOPTS_VALUE; });
  }

  /// How much later than they are decoded frames show, by the first that tells both: program streams say it of one
  /// picture in several.
  static std::int64_t delay_of(const std::vector<int>& order, const std::vector<std::int64_t>& decoded,
                               const std::vector<std::int64_t>& told) {
    for (std::size_t i = 0; i < order.size(); ++i)
      if (const std::int64_t shows = told[static_cast<std::size_t>(order[i])]; shows != AV_NOPTS_VALUE)
        return shows - decoded[i];
    return 0;
  }

  Result<void> order_frames(std::unique_ptr<FfmpegInput> input) {
    const AVCodecDescriptor* codec = avcodec_descriptor_get(input->stream().codecpar->codec_id);
    std::vector<std::int64_t> stamps, told;
    for (std::size_t i = 0; i < index_.packets.size(); ++i) {
      MoviePacket& packet = index_.packets[i];
      const bool timed = packet.dts != AV_NOPTS_VALUE;
      stamps.push_back(timed ? packet.dts : stamps.empty() ? 0 : stamps.back() + 1);
      told.push_back(packet.pts);
    }
    std::ranges::sort(stamps);
    std::vector<int> order;
    const bool reorders = codec && (codec->props & AV_CODEC_PROP_REORDER) != 0;
    for (std::size_t i = 0; i < index_.packets.size(); ++i) {
      if (!reorders && index_.packets[i].shown) order.push_back(static_cast<int>(i));
      index_.packets[i].pts = static_cast<std::int64_t>(i);
    }
    const std::size_t missing = index_.missing;
    sort_by_time(index_);
    begin(std::move(input));
    if (reorders) {
      AFTERGLOW_TRY(order, decoder_->order_by_decoding());
    }
    const std::int64_t later = delay_of(order, stamps, told);
    for (MoviePacket& packet : index_.packets) packet.shown = false;
    for (std::size_t i = 0; i < order.size(); ++i) {
      MoviePacket& packet = index_.packets[static_cast<std::size_t>(order[i])];
      packet.shown = true;
      packet.pts = stamps[i] + later;
    }
    sort_by_time(index_);
    if (index_.order.empty()) return Error{ErrorKind::io, "has no frame that can be decoded", request_.file.string()};
    index_.missing = missing;
    add_missing(index_, missing);
    AFTERGLOW_TRY(auto again, reopen(request_));
    begin(std::move(again));
    return {};
  }

  /// Of the first frame that is whole.
  Result<void> look_at_first() {
    constexpr int kMostTries = 64;
    const int frames = static_cast<int>(index_.order.size());
    Error why{ErrorKind::io, "has no frame"};
    for (int i = 0; i < std::min(frames, kMostTries); ++i) {
      auto first = decoder_->frame(i);
      if (!first) {
        why = std::move(first).error();
        continue;
      }
      facts_ = facts_of(decoder_->input(), **first);
      facts_.pts = index_.pts;
      facts_.clock = index_.parts;
      facts_.last_length = index_.missing == 0 ? index_.last_length : 0;
      facts_.missing = index_.missing;
      if (const auto filled = fill_in(facts_); !filled)
        return Error{ErrorKind::io, filled.error().message, request_.file.string()};
      AFTERGLOW_CHECK(
          check_sides({0, 0, facts_.size.width, facts_.size.height}, "frame", request_.limits, request_.file));
      if (is_readable_format(static_cast<AVPixelFormat>((*first)->format))) return {};
      return Error{ErrorKind::io,
                   fmt::format("is a video of a pixel format that is not read ({})", facts_.pixel_format),
                   request_.file.string()};
    }
    return Error{ErrorKind::io, "is a video without a frame that can be decoded: the first " + why.message,
                 request_.file.string()};
  }

  MovieRequest request_;
  MovieIndex index_;
  std::mutex mutex_;
  std::unique_ptr<FfmpegDecoder> decoder_;
  FfmpegPlanes planes_;
};

}  // namespace

Result<std::shared_ptr<MovieSource>> open_with_ffmpeg(const MovieRequest& request) {
  try {
    auto movie = std::make_shared<FfmpegMovie>();
    if (auto opened = movie->open(request); !opened) {
      Error error = std::move(opened).error();
      if (error.file.empty()) error.file = request.file.string();
      return error;
    }
    return std::shared_ptr<MovieSource>(std::move(movie));
  } catch (const std::exception& error) {
    return Error{ErrorKind::io, "cannot be read: " + exception_text(error), request.file.string()};
  }
}

}  // namespace afterglow
