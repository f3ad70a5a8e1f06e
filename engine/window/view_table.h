// SPDX-License-Identifier: MIT
// The table of a display, on the device.
#pragma once

#include <array>

#include "gpu/image.h"
#include "image/display_table.h"

namespace afterglow {

/// Drawing thread alone.
class ViewTable {
 public:
  /// What was recorded with the one before must be done. Errors: device.
  Result<void> take(const Device& device, const DisplayTable& table);
  /// Outside of rendering: brings a new table to the device.
  void upload(const Device& device, VkCommandBuffer commands);

  /// 0: there is none.
  int planes() const { return planes_; }
  /// As view.frag has it: bend, cells above and below 0, the plane of 0.
  const std::array<float, 4>& shaper() const { return shaper_; }
  VkImageView view() const { return image_.view(); }

 private:
  GpuImage image_;
  Buffer staging_;
  int planes_ = 0;
  std::array<float, 4> shaper_{};
  bool pending_ = false;
};

}  // namespace afterglow
