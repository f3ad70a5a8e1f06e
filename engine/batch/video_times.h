// SPDX-License-Identifier: MIT
// When the frames of a video that is written show, and what of their own video goes along.
#pragma once

#include <memory>
#include <optional>

#include "batch/frame_list.h"
#include "image/video_writer.h"

namespace afterglow {

/// Frames in the order in which they are written.
class VideoTimes {
 public:
  /// `rate`: of frames that have no times of their own.
  VideoTimes(std::filesystem::path file, Rational rate) : file_(std::move(file)), rate_(rate) {}

  /// The clock, and the video that sound and the rest are copied from. `last`: of the frames that were asked for.
  void begin(const FrameJob& first, const FrameJob& last, VideoPlan& plan);
  /// `index`: its place among those that were asked for. Errors: usage (frames of several videos, or backwards).
  Result<VideoTime> of(const FrameJob& job, std::size_t index);
  /// That of the last place of `frames`, where the one that was written last is to stay until then; 0: of none, since
  /// the video is to be shorter.
  std::optional<VideoTime> held(std::size_t frames, VideoTime last);
  /// The last frame of their video was among them, or they have none.
  bool whole() const { return whole_; }

 private:
  Error of_one() const;
  void use_even(const Rational& rate, VideoPlan& plan);
  VideoTime time_of(int frame);  ///< which is the last one from now on

  std::filesystem::path file_;
  Rational rate_;
  std::shared_ptr<Movie> movie_;  ///< that the frames come from
  long long ticks_ = 0;           ///< of a frame, where they come evenly but for the roundings of its clock; else 0
  long long late_ = 0;            ///< of those, before the first one shows
  int first_ = 0;                 ///< its first frame that is written
  long long start_ = 0;           ///< time stamp of that
  int last_ = -1;                 ///< its frame that was written last
  int wanted_ = -1;               ///< its last frame that was asked for; below 0: not known
  bool begun_ = false, whole_ = true;
};

}  // namespace afterglow
