// SPDX-License-Identifier: MIT
#include "batch/write_queue.h"

#include <utility>

#include "core/stopwatch.h"

namespace afterglow {

void WriteQueue::add(FrameRecord& frame, std::size_t index, Picture picture) {
  std::shared_future<Result<void>> before;
  if (sink_.is_one() && !writing_.empty()) before = writing_.back().written;
  const auto write = [this, &frame, index, before, picture = std::move(picture)]() -> Result<void> {
    // What came before could not be written: this would stand in a wrong place.
    if (before.valid())
      if (const Result<void>& earlier = before.get(); !earlier) return earlier;
    const auto start = Clock::now();
    auto written = sink_.write(frame.job, index, picture);
    frame.write = milliseconds_since(start);
    return written;
  };
  writing_.push_back({&frame, std::async(std::launch::async, write).share()});
}

std::optional<WriteQueue::Written> WriteQueue::take() {
  if (writing_.empty()) return std::nullopt;
  const Writing oldest = std::move(writing_.front());
  writing_.pop_front();
  return Written{oldest.frame, oldest.written.get()};
}

}  // namespace afterglow
