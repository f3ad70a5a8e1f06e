// SPDX-License-Identifier: MIT
#include "batch/video_times.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "image/movie.h"

namespace afterglow {
namespace {

/// A frame of a video file has that file's time; all others follow one another.
bool has_times(const FrameJob& job) { return job.movie && !job.passing; }

/// Where the file does not say it, that of the others on the average.
long long length_of_last(const MovieFacts& facts) {
  const auto& pts = facts.pts;
  if (facts.last_length > 0) return facts.last_length;
  return std::max(1LL, (pts.back() - pts.front()) / std::max<long long>(1, static_cast<long long>(pts.size()) - 1));
}

}  // namespace

Error VideoTimes::of_one() const {
  return {ErrorKind::usage, "takes frames of one video, by rising numbers, or pictures alone", file_.string()};
}

void VideoTimes::begin(const FrameJob& first, VideoPlan& plan) {
  plan.rate = first.passing && first.fps > 0 ? frame_rate(first.fps) : rate_;
  plan.time_base = {plan.rate.denominator, plan.rate.numerator};
  if (!has_times(first)) return;
  movie_ = first.movie;
  const MovieFacts& facts = movie_->facts();
  // Clocks of MPEG streams run from anywhere; those of other containers begin with the shot.
  const bool running = facts.container.starts_with("mpeg");
  if (running || first.movie_frame > 0) start_ = facts.pts[static_cast<std::size_t>(first.movie_frame)];
  plan.time_base = facts.time_base;
  if (facts.rate.numerator > 0) plan.rate = facts.rate;
  plan.source = movie_->file();
  const double unit = 1e6 * facts.time_base.numerator / facts.time_base.denominator;
  plan.range.shift = std::llround(static_cast<double>(start_) * unit);
  if (first.movie_frame > 0) plan.range.begin = plan.range.shift;
}

Result<VideoTime> VideoTimes::of(const FrameJob& job, std::size_t index) {
  if (has_times(job) != static_cast<bool>(movie_) || (movie_ && job.movie != movie_)) return of_one();
  // Frames that failed before the first one that came are held by it.
  if (!movie_) return VideoTime{std::exchange(begun_, true) ? static_cast<long long>(index) : 0, 1};
  const auto& pts = movie_->facts().pts;
  const auto at = static_cast<std::size_t>(job.movie_frame);
  if (last_ >= job.movie_frame) return of_one();
  last_ = job.movie_frame;
  whole_ = at + 1 == pts.size();
  return VideoTime{pts[at] - start_, whole_ ? length_of_last(movie_->facts()) : pts[at + 1] - pts[at]};
}

std::optional<VideoTime> VideoTimes::held(std::size_t frames, VideoTime last) const {
  const auto end = static_cast<long long>(frames) - 1;
  return !movie_ && end > last.pts ? std::optional(VideoTime{end, 1}) : std::nullopt;
}

}  // namespace afterglow
