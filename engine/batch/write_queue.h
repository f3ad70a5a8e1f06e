// SPDX-License-Identifier: MIT
// Frames on their way into a sink, beside the work on the next ones.
#pragma once

#include <deque>
#include <future>
#include <optional>

#include "batch/frame_sink.h"
#include "batch/run_report.h"
#include "image/pixel_memory.h"

namespace afterglow {

/// Used from one thread; waits for what has begun when it goes.
class WriteQueue {
 public:
  /// `memory` gets that of pictures that have been written. Both outlive it.
  WriteQueue(FrameSink& sink, PixelMemory& memory) : sink_(sink), memory_(memory) {}

  struct Written {
    FrameRecord* frame = nullptr;
    Result<void> result;
  };
  std::size_t size() const { return writing_.size(); }
  void add(FrameRecord& frame, std::size_t index, Picture picture);
  /// Waits for the oldest frame; nothing when none is on its way.
  std::optional<Written> take();

 private:
  struct Writing {
    FrameRecord* frame = nullptr;
    std::shared_future<Result<void>> written;
  };
  FrameSink& sink_;
  PixelMemory& memory_;
  std::deque<Writing> writing_;
};

}  // namespace afterglow
