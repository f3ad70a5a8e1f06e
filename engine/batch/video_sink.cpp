// SPDX-License-Identifier: MIT
#include "batch/video_sink.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <optional>
#include <string_view>
#include <utility>

#include "batch/video_times.h"
#include "core/temporary.h"
#include "image/metadata.h"

namespace afterglow {
namespace {

/// More than 8 bits are worth keeping.
bool is_deep(const FileFacts* facts) { return facts && (facts->floating || facts->bits > 8); }

class VideoSink : public FrameSink {
 public:
  VideoSink(std::filesystem::path file, const WriteOptions& options, double fps, FrameJob last,
            Diagnostics& diagnostics)
      : file_(std::move(file)),
        options_(options),
        times_(file_, frame_rate(fps)),
        last_wanted_(std::move(last)),
        diagnostics_(diagnostics) {}

  Result<void> check() const {
    if (options_.keep_layers)
      return Error{ErrorKind::usage, "only EXR files can keep layers", file_.string(), 0, ".exr"};
    if (options_.type != SampleType::automatic)
      return Error{ErrorKind::usage, "--type is for pictures; a video has --pix-fmt", file_.string()};
    if (!options_.compression.empty())
      return Error{ErrorKind::usage, "--compression is for pictures; a video has --codec and --crf", file_.string()};
    if (options_.png_level || options_.jpeg_quality)
      return Error{ErrorKind::usage,
                   fmt::format("{} is for pictures; a video has --codec and --crf",
                               options_.png_level ? "--png-level" : "--jpeg-quality"),
                   file_.string()};
    AFTERGLOW_TRY(const VideoPlan plan, plan_video(file_, options_, false, false));
    AFTERGLOW_CHECK(check_video_encoder(plan, file_));
    AFTERGLOW_CHECK(check_place(file_));
    return check_replaceable(file_);
  }

  Result<void> takes(const FrameJob& job, const Picture& picture) override { return size_.takes(job, picture); }

  /// Once the video is open, a frame is packed while those before it are encoded.
  Result<void> write(const FrameJob& job, std::size_t index, const Picture& picture, const Turn& turn) override {
    std::optional<Result<PackedFrame>> packed;
    if (VideoWriter* const writer = opened_.load()) packed = pack(*writer, picture);
    AFTERGLOW_CHECK(turn());
    if (!writer_) AFTERGLOW_CHECK(begin(job, job.movie ? 0 : index, picture));
    AFTERGLOW_TRY(const VideoTime time, times_.of(job, index));
    if (!packed) packed = pack(*writer_, picture);
    AFTERGLOW_TRY(PackedFrame frame, std::move(*packed));
    AFTERGLOW_CHECK(write_last());
    last_.emplace(std::move(frame), time);
    return {};
  }

  /// By what the encoders of Debian 12 were seen to take: those that look ahead keep some forty frames, in several
  /// sizes.
  std::uint64_t bytes_held(Size size) const override {
    const auto plan = plan_video(file_, options_, true, false);
    if (!plan) return 0;
    constexpr std::array<std::string_view, 4> kLookAhead{"h264", "h265", "vp9", "av1"};
    constexpr std::uint64_t kBase = 48u << 20, kAhead = 240, kOthers = 160;  // bytes a pixel, at 8 bits
    const bool ahead = std::ranges::find(kLookAhead, plan->codec) != kLookAhead.end();
    const std::uint64_t sample = plan->pack.layout->bits > 8 ? 2 : 1;
    return kBase + static_cast<std::uint64_t>(size.area()) * (ahead ? kAhead : kOthers) * sample;
  }

  /// The last frame holds the places of those behind it that failed: it comes once more.
  Result<void> finish(std::size_t frames) override {
    if (!writer_ || !last_) return {};
    const auto held = times_.held(frames, last_->second);
    std::optional<PackedFrame> again;
    if (held) again = last_->first;
    AFTERGLOW_CHECK(write_last());
    if (held) AFTERGLOW_CHECK(writer_->write(std::move(*again), *held));
    return writer_->finish(times_.whole());
  }

 private:
  /// From any thread.
  Result<PackedFrame> pack(VideoWriter& writer, const Picture& picture) {
    const PixelLayout& layout = *writer.plan().pack.layout;
    if (!layout.alpha && !warned_ && has_transparency(picture)) {
      warned_ = true;
      diagnostics_.warn_once("no alpha", fmt::format("{}: {} as {} has no alpha; the pictures are put on black",
                                                     file_.string(), writer.plan().codec, layout.name));
    }
    return writer.pack(picture);
  }
  Result<void> write_last() {
    if (!last_) return {};
    auto [frame, time] = *std::exchange(last_, std::nullopt);
    return writer_->write(std::move(frame), time);
  }
  Result<void> begin(const FrameJob& job, std::size_t held, const Picture& picture) {
    AFTERGLOW_TRY(VideoPlan plan, plan_video(file_, options_, is_deep(picture.facts.get()), picture.has_alpha));
    plan.size = picture.display_window.size();
    plan.pack.space = video_space(options_, *plan.pack.layout, picture.view);
    if (picture.view && !options_.space && describe_view(options_, plan))
      diagnostics_.note(
          fmt::format("{}: the codes of the view are stored with 8 bits; of an HDR view they show steps: "
                      "--pix-fmt yuv420p10le has 10",
                      file_.string()));
    times_.begin(job, last_wanted_, plan);
    if (picture.facts) keep_facts(*picture.facts, plan, held);
    constexpr int kPq = 16;
    if (plan.transfer == kPq && job.movie && job.movie->facts().hdr_metadata)
      diagnostics_.warn_once(
          "hdr metadata", fmt::format("{}: what the input says of its display and its brightest light (HDR10) is not "
                                      "kept: it was of other pictures",
                                      file_.string()));
    if (job.passing && job.movie && job.movie->facts().sound && plan.audio.empty() && !plan.silent &&
        !options_.video.piece)
      diagnostics_.warn_once("sound of a stream",
                             fmt::format("{}: the sound of {} is not copied; --audio takes it from a file",
                                         file_.string(), job.input.string()));
    if (plan.container == "gif") AFTERGLOW_CHECK(check_hundredths(job, plan));
    if (options_.video.piece) plan.source.clear();
    AFTERGLOW_TRY(writer_, VideoWriter::open(file_, std::move(plan), diagnostics_));
    opened_ = writer_.get();
    return {};
  }

  /// GIF's clock. Errors: usage (frames come faster than it ticks).
  Result<void> check_hundredths(const FrameJob& job, const VideoPlan& plan) const {
    constexpr long long kNone = 100;
    const auto tick = [](long long pts, const Rational& base) {
      return std::llround(100.0 * static_cast<double>(pts) * base.numerator / base.denominator);
    };
    long long shortest = kNone;
    if (job.movie && !job.passing) {
      const auto& pts = job.movie->facts().pts;
      const Rational& base = job.movie->facts().time_base;
      for (std::size_t i = 1; i < pts.size(); ++i)
        shortest = std::min(shortest, tick(pts[i], base) - tick(pts[i - 1], base));
    } else {
      const double rate = static_cast<double>(plan.rate.numerator) / plan.rate.denominator;
      shortest = rate > 100 ? 0 : rate > 50 ? 1 : kNone;
    }
    if (shortest < 1)
      return Error{ErrorKind::usage, "GIF tells the times of frames in hundredths of a second; these come faster",
                   file_.string(), 0, "up to 100 frames a second (players show up to 50); apng and webm take more"};
    if (shortest < 2)
      diagnostics_.warn_once(
          "gif clock", fmt::format("{}: GIF holds hundredths of a second, and players show delays below 2 as 10: more "
                                   "than 50 frames a second play too slowly",
                                   file_.string()));
    return {};
  }

  std::filesystem::path file_;
  WriteOptions options_;
  VideoTimes times_;
  FrameJob last_wanted_;  ///< of a video, or none
  OneSize size_;
  Diagnostics& diagnostics_;
  std::unique_ptr<VideoWriter> writer_;
  std::optional<std::pair<PackedFrame, VideoTime>> last_;  ///< that waits for what comes behind it
  std::atomic<VideoWriter*> opened_ = nullptr;             ///< the same, for frames whose turn has not come
  std::atomic<bool> warned_ = false;                       ///< of alpha, which nobody looks for any more
};

}  // namespace

Result<std::unique_ptr<FrameSink>> open_video_sink(const std::filesystem::path& file, const WriteOptions& options,
                                                   double fps, const FrameJob* last, Diagnostics& diagnostics) {
  auto sink = std::make_unique<VideoSink>(file, options, fps, last ? *last : FrameJob{}, diagnostics);
  AFTERGLOW_CHECK(sink->check());
  return std::unique_ptr<FrameSink>(std::move(sink));
}

}  // namespace afterglow
