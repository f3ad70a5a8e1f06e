// SPDX-License-Identifier: MIT
// One video that is being written, whole or not at all: of pictures, or of pieces that were written before.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "image/video_output.h"
#include "image/video_target.h"

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

/// Not thread-safe but for `pack`.
class VideoWriter {
 public:
  /// Nothing appears at `file` before finish(). Errors: io (no such encoder, the file cannot be made), usage (sides).
  static Result<std::unique_ptr<VideoWriter>> open(const std::filesystem::path& file, VideoPlan plan,
                                                   Diagnostics& diagnostics);

  const VideoPlan& plan() const { return plan_; }
  /// The picture as a frame of this video; from any thread, beside all else. Errors: io (of another size, no memory).
  Result<PackedFrame> pack(const Picture& picture);
  /// Frames come by rising times. Errors: io (disk full, …).
  Result<void> write(PackedFrame frame, VideoTime time);
  /// Ends the file and gives it its name.
  Result<void> finish(bool whole);

 private:
  VideoWriter() = default;

  VideoPlan plan_;
  std::mutex mutex_;                               // guards what follows
  std::vector<std::vector<std::uint8_t>> packed_;  ///< memory of frames that have been written
  std::unique_ptr<VideoTarget> target_;            // outlives the encoder, which writes into it
  std::unique_ptr<VideoEncoder> encoder_;
};

/// Whether one of the plan's encoders is there. Errors: io (the module cannot be loaded), usage (none is).
Result<void> check_video_encoder(const VideoPlan& plan, const std::filesystem::path& file);

/// A part of a video: a file of the same container, with frames alone.
struct VideoPiece {
  std::filesystem::path file;
  std::vector<VideoTime> times;  ///< of its frames in the order in which they show
};
/// What one file is to be made of.
struct VideoPieces {
  std::vector<VideoPiece> pieces;
  bool whole = true;  ///< as VideoEncoder::finish
  std::function<bool()> interrupted;
};

/// One file of all pieces, whose packets go into it as they are; with sound and all else as `plan` says, of which size,
/// layout and encoder are not used. Errors: io (a piece that is damaged, has other frames or was encoded in another
/// way), interrupted.
Result<void> join_video(const std::filesystem::path& file, const VideoPlan& plan, const VideoPieces& pieces,
                        Diagnostics& diagnostics);

}  // namespace afterglow
