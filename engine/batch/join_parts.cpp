// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "batch/batch_run.h"
#include "batch/frame_sink.h"
#include "batch/video_times.h"
#include "core/file.h"
#include "core/text.h"

namespace afterglow {
namespace {

/// Of these a frame is what has changed since the one before.
constexpr std::array kOfDifferences{".gif", ".apng"};

/// Clock, source and times of the whole.
struct WholeVideo {
  VideoPlan plan;
  std::vector<VideoTime> times;
  bool whole = true;
};

Result<WholeVideo> whole_video(const BatchRequest& request, const std::vector<FrameJob>& frames) {
  WholeVideo out;
  const auto& file = request.files.output;
  AFTERGLOW_TRY(out.plan, plan_video(file, request.loop.write, false, false));
  VideoTimes times(file, frame_rate(request.loop.fps));
  times.begin(frames.front(), frames.back(), out.plan);
  AFTERGLOW_TRY(out.plan.patience, patience_of_process());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    AFTERGLOW_TRY(const VideoTime time, times.of(frames[i], i + frames[i].missing));
    out.times.push_back(time);
  }
  out.whole = times.whole();
  return out;
}

}  // namespace

Result<void> check_parts(const BatchRequest& request, const std::vector<FrameJob>& frames, Diagnostics& diagnostics) {
  const std::filesystem::path file = request.files.output;
  const std::string extension = lower(file.extension().string());
  if (std::ranges::find(kOfDifferences, extension) != kOfDifferences.end())
    return Error{ErrorKind::usage, fmt::format("{} files cannot be joined from pieces", extension.substr(1)),
                 file.string(), 0, "mp4, mov, mkv, webm, or pictures, which `afterglow run` makes one of"};
  AFTERGLOW_TRY(const auto sink, open_sink(request.files, request.loop, frames.size(), &frames.back(), diagnostics));
  if (!sink->is_one()) {
    std::vector<std::filesystem::path> outputs;
    std::ranges::transform(frames, std::back_inserter(outputs), &FrameJob::output);
    return check_pictures(outputs, request.files, request.loop.write);
  }
  const auto& audio = request.loop.write.video.audio;
  if (is_audio_file(audio) && !is_file(audio)) return missing_file(audio);
  AFTERGLOW_TRY(const WholeVideo video, whole_video(request, frames));
  return {};
}

Result<void> join_parts(const BatchRequest& request, const std::vector<FrameJob>& frames,
                        const std::vector<VideoPart>& parts, const RunEvents& events) {
  AFTERGLOW_TRY(const WholeVideo video, whole_video(request, frames));
  VideoPieces pieces{.pieces = {}, .whole = video.whole, .interrupted = events.interrupted};
  auto next = video.times.begin();
  for (const VideoPart& part : parts) {
    if (part.frames > static_cast<std::size_t>(video.times.end() - next)) break;
    const auto end = next + static_cast<std::ptrdiff_t>(part.frames);
    pieces.pieces.push_back({part.file, std::vector(next, end)});
    next = end;
  }
  if (pieces.pieces.size() != parts.size() || next != video.times.end())
    return Error{ErrorKind::io, fmt::format("the pieces are not those of {} frames", frames.size()),
                 request.files.output};
  return join_video(request.files.output, video.plan, pieces, events.diagnostics);
}

}  // namespace afterglow
