// SPDX-License-Identifier: MIT
// One video that is being written, whole or not at all.
#pragma once

#include <memory>

#include "image/output_file.h"
#include "image/video_output.h"

namespace afterglow {

/// When a frame shows, in units of VideoPlan::time_base.
struct VideoTime {
  long long pts = 0, duration = 1;
};

/// What the module does: frames become packets, packets a file. Not thread-safe. Errors: io.
class VideoEncoder {
 public:
  virtual ~VideoEncoder() = default;
  virtual Result<void> write(const PackedFrame& frame, VideoTime time) = 0;
  /// The last packets, and what else the file needs. `whole`: all that is left of the source's other streams, too;
  /// else what lies beside the frames.
  virtual Result<void> finish(bool whole) = 0;
};

/// Not thread-safe.
class VideoWriter {
 public:
  /// Nothing appears at `file` before finish(). Errors: io (no such encoder, the file cannot be made), usage (sides).
  static Result<std::unique_ptr<VideoWriter>> open(const std::filesystem::path& file, VideoPlan plan,
                                                   Diagnostics& diagnostics);
  ~VideoWriter();

  const VideoPlan& plan() const { return plan_; }
  /// Frames come by rising times. Errors: io (disk full, …), usage (a frame of another size).
  Result<void> write(const Picture& picture, VideoTime time);
  /// Ends the file and gives it its name.
  Result<void> finish(bool whole);

 private:
  VideoWriter() = default;
  Error named(Error error) const;

  std::filesystem::path file_, target_, temporary_;
  VideoPlan plan_;
  std::unique_ptr<OutputFile> out_;
  std::unique_ptr<VideoEncoder> encoder_;
  bool committed_ = false;
};

/// Whether one of the plan's encoders is there. Errors: io (the module cannot be loaded), usage (none is).
Result<void> check_video_encoder(const VideoPlan& plan, const std::filesystem::path& file);

}  // namespace afterglow
