// SPDX-License-Identifier: MIT
// What a run wants of a frame, from its header: how large it is made, what the preset says of it, what it takes.
#pragma once

#include <cstdint>
#include <optional>

#include "batch/frame_sink.h"
#include "image/cuts.h"
#include "image/reader.h"
#include "image/scale.h"
#include "image/writer.h"
#include "session/session.h"

namespace afterglow {

struct FrameLoopOptions {
  ReadOptions read;  ///< depth, normal and motion are those of each frame
  WriteOptions write;
  bool keep_partial = false;     ///< an interrupted run leaves what the sink has
  std::optional<SizeWish> size;  ///< of the display window; pictures are scaled to it before the stack
  std::optional<Rect> region;    ///< part of the display window that is wanted
  bool reuse = true;             ///< pictures that were just run are not run again
  bool view = false;             ///< what comes out is Picture::view
  double fps = 24;
  bool takes_fps = false;  ///< nobody asked for one: a video takes that of its first picture, where it says one
  std::uint64_t max_memory = 6ull << 30;
  bool fail_fast = false;
  bool whole_pre_roll = false;  ///< an earlier frame that cannot be read ends the run: what follows would be another
  NanPolicy nan_policy = NanPolicy::zero;  ///< fail: every pass of every frame is looked at, and nothing mended
  bool histories = false;                  ///< pictures depend on the frames before them
  Cuts cuts;                               ///< where histories begin anew
};

/// Bytes that a frame takes.
struct FrameNeed {
  std::uint64_t device = 0, reading = 0, result = 0;
  std::uint64_t held = 0;       ///< whatever the number of frames: decoders' and encoders' frames
  std::uint64_t in_flight = 0;  ///< pictures of the frames beside the one that is processed, and what all are staged in
  std::uint64_t one_frame() const { return device + reading + result + held; }
  /// So many are read, one is processed, `written` are being written.
  std::uint64_t frames(std::uint64_t read, std::uint64_t written) const {
    return device + in_flight + (1 + read) * reading + (1 + written) * result + held;
  }
};

/// Frames beside the one that is processed; none: one after the other.
struct Overlap {
  std::size_t read = 0, written = 0;  ///< at a time
  explicit operator bool() const { return read > 0; }
  bool operator==(const Overlap&) const = default;
};
/// As many as keep the processors busy, two and three at the least, and `max_memory` has room for. `in_order`: what
/// gives its frames one by one has no use for two readers.
Overlap overlap_of(const FrameNeed& need, std::uint64_t max_memory, unsigned processors, bool in_order);

/// Of a frame whose picture has not been read.
struct PlannedFrame {
  const FrameJob* job = nullptr;
  PictureHeader header;
  FrameRequest request;
};

/// Used from one thread. Errors name the frame's file.
class FramePlanner {
 public:
  /// All of them outlive it.
  FramePlanner(Session& session, const FrameSink& sink, const FrameLoopOptions& options)
      : session_(session), sink_(sink), options_(options) {}

  ReadOptions read_options(const FrameJob& job) const;
  std::optional<Scaling> scaling_of(const PictureHeader& header) const;
  /// Where --size squeezes pictures of square pixels; of others the file says the shape of pixels anew.
  void tell_of_shape(const PictureHeader& header, const FrameJob& job, Diagnostics& diagnostics) const;
  /// Reads the header. `step`: frames since the one before; `restart`: there is none. Errors: io, script.
  Result<PlannedFrame> plan(const FrameJob& job, double step, bool restart);
  /// Errors: io (above --max-memory).
  Result<FrameNeed> need_of(const PictureHeader& header, const Build& build, const FrameJob& job);
  std::uint64_t largest_need() const { return largest_need_; }
  /// Whether the region that is asked for lies in a picture with this header. Errors: io.
  Result<void> check_region(const PictureHeader& header) const;
  /// In which the look runs on a picture with this header.
  Size size_of(const PictureHeader& header) const { return shape_of(header).size(); }

 private:
  Error too_large(const FrameNeed& need, Size source, Size made, const std::string& file) const;
  /// Of what the look runs on: `finer` times the windows on each side.
  struct Shape {
    Rect data, display;
    int finer = 1;
    double length_scale = 1;
    Size size() const { return {data.width * finer, data.height * finer}; }
  };
  Shape shape_of(const PictureHeader& header) const;
  BuildContext context_of(const FrameJob& job, const PictureHeader& header) const;
  Result<FrameRequest> request_of(const FrameJob& job, const PictureHeader& header, double step, bool restart);

  Session& session_;
  const FrameSink& sink_;
  const FrameLoopOptions& options_;
  std::uint64_t largest_need_ = 0;
};

/// An error that names no file gets the frame's.
Error named(Error error, const FrameJob& job);

}  // namespace afterglow
