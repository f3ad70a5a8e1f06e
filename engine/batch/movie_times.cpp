// SPDX-License-Identifier: MIT
#include "batch/movie_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/text.h"
#include "image/video_writer.h"

namespace afterglow {
namespace {

/// A frame of a video whose frames show for lengths that differ by more than its clock rounds; null: there is none.
const FrameJob* uneven(const std::vector<FrameJob>& frames) {
  constexpr double kSame = 0.05, kRoundings = 2;
  double shortest = INFINITY, longest = 0;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const FrameJob &before = frames[i - 1], &job = frames[i];
    if (job.movie != before.movie) {
      shortest = INFINITY;
      longest = 0;
    }
    if (!job.movie || job.passing || job.movie != before.movie || job.movie_frame != before.movie_frame + 1) continue;
    const auto& pts = job.movie->facts().pts;
    const auto at = static_cast<std::size_t>(job.movie_frame);
    const auto length = static_cast<double>(pts[at] - pts[at - 1]);
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
    if (longest - shortest > std::max(kRoundings, kSame * longest)) return &job;
  }
  return nullptr;
}

}  // namespace

void tell_of_own_times(double fps, const std::vector<FrameJob>& frames, Diagnostics& diagnostics) {
  if (frames.empty() || !frames.front().movie || frames.front().fps <= 0) return;
  constexpr double kSame = 1e-3;
  const double own = frames.front().fps;
  if (std::abs(fps - own) <= kSame * own) return;
  diagnostics.warn(fmt::format("{}: frames of a video keep their own times ({} a second); --fps is for pictures",
                               frames.front().input.string(), number_text(own)));
}

void tell_of_lost_times(const std::string& output, const std::vector<FrameJob>& frames, Diagnostics& diagnostics) {
  const FrameJob* const one = is_video_output(output) ? nullptr : uneven(frames);
  if (!one) return;
  diagnostics.warn(fmt::format(
      "{}: its frames come at no even rate, which {} cannot say; .mp4, .mov and .mkv keep the times, and ffmpeg "
      "-fps_mode cfr makes the rate even before",
      one->input.string(), output == "-" ? "a stream" : "pictures"));
}

}  // namespace afterglow
