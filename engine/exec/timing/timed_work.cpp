// SPDX-License-Identifier: MIT
#include "exec/timing/timed_work.h"

#include "core/stopwatch.h"

namespace afterglow {

Result<TimedWork> TimedWork::create(const Device& device, const std::function<void(VkCommandBuffer)>& record) {
  TimedWork out;
  AFTERGLOW_TRY(out.submitter_, Submitter::create(device));
  AFTERGLOW_CHECK(out.submitter_.record(record));
  return out;
}

Result<double> TimedWork::run() {
  const auto start = Clock::now();
  AFTERGLOW_CHECK(submitter_.submit_again());
  AFTERGLOW_CHECK(submitter_.wait());
  return milliseconds_since(start);
}

}  // namespace afterglow
