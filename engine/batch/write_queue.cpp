// SPDX-License-Identifier: MIT
#include "batch/write_queue.h"

#include <algorithm>
#include <utility>

#include "core/beside.h"
#include "core/file_time.h"
#include "core/stopwatch.h"

namespace afterglow {

void WriteQueue::add(FrameRecord& frame, std::size_t index, Picture picture) {
  std::shared_future<Result<void>> before;
  if (sink_.is_one() && !writing_.empty()) before = writing_.back().written;
  auto write = [this, &frame, index, before, picture = std::move(picture)]() mutable -> Result<void> {
    double waited = 0;
    // What came before could not be written: this would stand in a wrong place.
    const auto turn = [&before, &waited]() -> Result<void> {
      if (!before.valid()) return {};
      const auto start = Clock::now();
      Result<void> earlier = before.get();
      before = {};  // else each would hold all that were before it
      waited += milliseconds_since(start);
      return earlier;
    };
    const auto start = Clock::now();
    const double files = FileTime::of_thread();
    auto written = sink_.write(frame.job, index, picture, turn);
    frame.steps.write = milliseconds_since(start) - waited;
    frame.steps.encode = std::max(0.0, frame.steps.write - (FileTime::of_thread() - files));
    memory_.give(std::move(picture));
    return written;
  };
  writing_.push_back({&frame, beside(std::move(write)).share()});
}

std::optional<WriteQueue::Written> WriteQueue::take() {
  if (writing_.empty()) return std::nullopt;
  const Writing oldest = std::move(writing_.front());
  writing_.pop_front();
  return Written{oldest.frame, oldest.written.get()};
}

}  // namespace afterglow
