// SPDX-License-Identifier: MIT
#include "batch/video_sink.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "image/metadata.h"
#include "image/movie.h"
#include "image/video_writer.h"

namespace afterglow {
namespace {

/// More than 8 bits are worth keeping.
bool is_deep(const FileFacts* facts) { return facts && (facts->floating || facts->bits > 8); }

class VideoSink : public FrameSink {
 public:
  VideoSink(std::filesystem::path file, const WriteOptions& options, double fps, Diagnostics& diagnostics)
      : file_(std::move(file)), options_(options), rate_(frame_rate(fps)), diagnostics_(diagnostics) {}

  Result<void> check() const {
    if (options_.keep_layers)
      return Error{ErrorKind::usage, "only EXR files can keep layers", file_.string(), 0, ".exr"};
    if (options_.type != SampleType::automatic)
      return Error{ErrorKind::usage, "--type is for pictures; a video has --pix-fmt", file_.string()};
    if (!options_.compression.empty())
      return Error{ErrorKind::usage, "--compression is for pictures; a video has --codec and --crf", file_.string()};
    AFTERGLOW_TRY(const VideoPlan plan, plan_video(file_, options_, false, false));
    AFTERGLOW_CHECK(check_video_encoder(plan, file_));
    return check_place(file_);
  }

  Result<void> write(const FrameJob& job, std::size_t index, const Picture& picture) override {
    if (!writer_) AFTERGLOW_CHECK(begin(job, picture));
    if (picture.has_alpha && !writer_->plan().pack.layout->alpha)
      diagnostics_.warn_once("no alpha",
                             fmt::format("{}: {} as {} has no alpha; the pictures are put on black", file_.string(),
                                         writer_->plan().codec, writer_->plan().pack.layout->name));
    AFTERGLOW_TRY(const VideoTime time, time_of(job, index));
    return writer_->write(picture, time);
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

  Result<void> finish(std::size_t) override { return writer_ ? writer_->finish(whole_) : Result<void>(); }

 private:
  /// A frame of a video file has that file's time; all others follow one another.
  static bool has_times(const FrameJob& job) { return job.movie && !job.passing; }

  Result<VideoTime> time_of(const FrameJob& job, std::size_t index) {
    if (has_times(job) != static_cast<bool>(movie_) || (movie_ && job.movie != movie_)) return of_one();
    if (!movie_) return VideoTime{static_cast<long long>(index), 1};
    const auto& pts = movie_->facts().pts;
    const auto at = static_cast<std::size_t>(job.movie_frame);
    if (last_ >= job.movie_frame) return of_one();
    last_ = job.movie_frame;
    whole_ = at + 1 == pts.size();
    const long long mean = std::max(1LL, (pts.back() - pts.front()) / std::max<long long>(1, pts.size() - 1));
    return VideoTime{pts[at] - start_, whole_ ? mean : pts[at + 1] - pts[at]};
  }
  Error of_one() const {
    return {ErrorKind::usage, "takes frames of one video, by rising numbers, or pictures alone", file_.string()};
  }

  /// Times, sound and the rest of the video that the frames come from.
  void follow(const FrameJob& job, VideoPlan& plan) {
    const MovieFacts& facts = job.movie->facts();
    movie_ = job.movie;
    // Clocks of MPEG streams run from anywhere; those of other containers begin with the shot.
    const bool running = facts.container.starts_with("mpeg");
    if (running || job.movie_frame > 0) start_ = facts.pts[static_cast<std::size_t>(job.movie_frame)];
    plan.time_base = facts.time_base;
    if (facts.rate.numerator > 0) plan.rate = facts.rate;
    plan.source = movie_->file();
    const double unit = 1e6 * facts.time_base.numerator / facts.time_base.denominator;
    plan.range.shift = std::llround(static_cast<double>(start_) * unit);
    if (job.movie_frame > 0) plan.range.begin = plan.range.shift;
  }

  Result<void> begin(const FrameJob& job, const Picture& picture) {
    AFTERGLOW_TRY(VideoPlan plan, plan_video(file_, options_, is_deep(picture.facts.get()), picture.has_alpha));
    plan.size = picture.display_window.size();
    plan.rate = job.passing && job.fps > 0 ? frame_rate(job.fps) : rate_;
    plan.time_base = {plan.rate.denominator, plan.rate.numerator};
    if (has_times(job)) follow(job, plan);
    AFTERGLOW_TRY(writer_, VideoWriter::open(file_, std::move(plan), diagnostics_));
    return {};
  }

  std::filesystem::path file_;
  WriteOptions options_;
  Rational rate_;
  Diagnostics& diagnostics_;
  std::unique_ptr<VideoWriter> writer_;
  std::shared_ptr<Movie> movie_;  ///< that the frames come from
  long long start_ = 0;           ///< time stamp of its first frame that is written
  int last_ = -1;                 ///< its frame that was written last
  bool whole_ = true;             ///< its last frame was written
};

}  // namespace

Result<std::unique_ptr<FrameSink>> open_video_sink(const std::filesystem::path& file, const WriteOptions& options,
                                                   double fps, Diagnostics& diagnostics) {
  auto sink = std::make_unique<VideoSink>(file, options, fps, diagnostics);
  AFTERGLOW_CHECK(sink->check());
  return std::unique_ptr<FrameSink>(std::move(sink));
}

}  // namespace afterglow
