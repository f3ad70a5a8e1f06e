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

/// Whether whole units of a clock are a frame of this rate.
bool ticks(const Rational& base, const Rational& rate) {
  return static_cast<long long>(rate.denominator) * base.denominator %
             (static_cast<long long>(rate.numerator) * base.numerator) ==
         0;
}

/// Of sound that begins with the sequence.
CopyRange range_of(const SequencePart& part, const Rational& rate) {
  const auto microseconds = [&](int frames) { return std::llround(frames * 1e6 * rate.denominator / rate.numerator); };
  CopyRange range;
  range.shift = microseconds(part.before);
  if (part.before > 0) range.begin = range.shift;
  if (part.length > 0) range.end = microseconds(part.before + part.length);
  return range;
}

}  // namespace

Error VideoTimes::of_one() const {
  return {ErrorKind::usage, "takes frames of one video, by rising numbers, or pictures alone", file_.string()};
}

void VideoTimes::begin(const FrameJob& first, const FrameJob& last, VideoPlan& plan) {
  plan.rate = first.passing && first.fps > 0 ? frame_rate(first.fps) : rate_;
  plan.time_base = {plan.rate.denominator, plan.rate.numerator};
  if (!has_times(first)) {
    plan.audio_range = range_of(first.part, plan.rate);
    return;
  }
  movie_ = first.movie;
  if (last.movie == movie_) wanted_ = last.movie_frame;
  const MovieFacts& facts = movie_->facts();
  // Clocks of MPEG streams run from anywhere; those of other containers begin with the shot.
  const bool running = facts.container.starts_with("mpeg");
  if (running || first.movie_frame > 0) start_ = facts.pts[static_cast<std::size_t>(first.movie_frame)];
  first_ = first.movie_frame;
  plan.time_base = facts.time_base;
  if (facts.rate.numerator > 0) plan.rate = facts.rate;
  // Matroska rounds to milliseconds, with which every other container would tell of a rate that changes.
  if (const auto rate = movie_->even_rate(); rate && !ticks(facts.time_base, *rate)) use_even(*rate, plan);
  if (!facts.pictures_alone) plan.source = movie_->file();
  const auto microseconds = [&](long long pts) {
    return std::llround(static_cast<double>(pts) * 1e6 * facts.time_base.numerator / facts.time_base.denominator);
  };
  const auto range_from = [&](long long zero) {
    CopyRange range;
    range.shift = microseconds(start_ - zero);
    if (first.movie_frame > 0) range.begin = range.shift;
    const auto behind = static_cast<std::size_t>(wanted_ + 1);
    if (wanted_ >= 0 && behind < facts.pts.size()) range.end = microseconds(facts.pts[behind] - zero);
    return range;
  };
  plan.range = range_from(0);
  plan.range.clock = facts.clock;
  plan.audio_range = range_from(running ? facts.pts.front() : 0);
}

/// Whole frames are units of the clock, or thousands of them where the file does not begin with one: also of its parts,
/// which become one video.
void VideoTimes::use_even(const Rational& rate, VideoPlan& plan) {
  constexpr int kFine = 1000, kMost = 1'000'000;
  const MovieFacts& facts = movie_->facts();
  const double unit = static_cast<double>(facts.time_base.numerator) / facts.time_base.denominator * rate.numerator /
                      rate.denominator;  // in frames
  const auto frames = [&](long long pts) { return static_cast<double>(pts) * unit; };
  const double begins = frames(facts.pts.front());
  const bool whole = std::abs(begins - std::round(begins)) <= unit || rate.numerator > kMost;
  ticks_ = whole ? 1 : kFine;
  late_ = std::llround(frames(facts.pts[static_cast<std::size_t>(first_)] - start_) * static_cast<double>(ticks_));
  plan.rate = rate;
  plan.time_base = {rate.denominator, rate.numerator * static_cast<int>(ticks_)};
}

Result<VideoTime> VideoTimes::of(const FrameJob& job, std::size_t index) {
  if (has_times(job) != static_cast<bool>(movie_) || (movie_ && job.movie != movie_)) return of_one();
  // Frames that failed before the first one that came are held by it.
  if (!movie_) return VideoTime{std::exchange(begun_, true) ? static_cast<long long>(index) : 0, 1};
  if (last_ >= job.movie_frame) return of_one();
  return time_of(job.movie_frame);
}

VideoTime VideoTimes::time_of(int frame) {
  const auto& pts = movie_->facts().pts;
  const auto at = static_cast<std::size_t>(frame);
  last_ = frame;
  whole_ = at + 1 == pts.size();
  if (ticks_ > 0) return {late_ + static_cast<long long>(frame - first_) * ticks_, ticks_};
  return {pts[at] - start_, whole_ ? length_of_last(movie_->facts()) : pts[at + 1] - pts[at]};
}

std::optional<VideoTime> VideoTimes::held(std::size_t frames, VideoTime last) {
  if (movie_) return frames > 0 && wanted_ > last_ ? std::optional(time_of(wanted_)) : std::nullopt;
  const auto end = static_cast<long long>(frames) - 1;
  return end > last.pts ? std::optional(VideoTime{end, 1}) : std::nullopt;
}

}  // namespace afterglow
