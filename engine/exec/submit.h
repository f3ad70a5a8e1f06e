// SPDX-License-Identifier: MIT
// Command buffers that are recorded, submitted and waited for, again and again, one at a time; the same commands need
// not be recorded twice.
#pragma once

#include <array>
#include <functional>
#include <utility>

#include "gpu/device.h"
#include "gpu/handle.h"

namespace afterglow {

class Submitter {
 public:
  static constexpr int kBuffers = 3;  ///< `which` counts from 0
  static Result<Submitter> create(const Device& device);
  Submitter() = default;
  Submitter(Submitter&& other) noexcept { *this = std::move(other); }
  Submitter& operator=(Submitter&& other) noexcept;
  ~Submitter() { (void)wait(); }

  /// Records anew with `record` and submits. Waits for the submission before, if it is still on its way. Errors:
  /// device.
  Result<void> submit(const std::function<void(VkCommandBuffer)>& record, int which = 0);
  /// Records without submitting. Waits like `submit`. Errors: device.
  Result<void> record(const std::function<void(VkCommandBuffer)>& record, int which = 0);
  /// What was recorded last into this buffer, once more or for the first time: nothing that it uses may have changed.
  /// Errors: device.
  Result<void> submit_again(int which = 0);
  /// Until the last submission is done; at once when there is none. Errors: device (lost).
  Result<void> wait();
  int recordings() const { return recordings_; }  ///< so far

 private:
  const Device* device_ = nullptr;
  CommandPoolHandle pool_;
  FenceHandle fence_;
  std::array<VkCommandBuffer, kBuffers> commands_{};
  bool pending_ = false;
  int recordings_ = 0;
};

}  // namespace afterglow
