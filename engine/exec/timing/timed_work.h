// SPDX-License-Identifier: MIT
// Work for the device that is recorded once and submitted again and again.
#pragma once

#include <functional>

#include "exec/submit.h"

namespace afterglow {

class TimedWork {
 public:
  /// What is recorded must be right to run any number of times. Errors: device.
  static Result<TimedWork> create(const Device& device, const std::function<void(VkCommandBuffer)>& record);
  TimedWork() = default;

  /// Submits and waits; milliseconds from one to the other. Errors: device.
  Result<double> run();

 private:
  Submitter submitter_;
};

}  // namespace afterglow
