// SPDX-License-Identifier: MIT
// Brings what the processor makes of a view into a target.
#pragma once

#include <vector>

#include "gpu/memory.h"
#include "window/plain_view.h"

namespace afterglow {

/// Drawing thread alone. The Device must outlive it.
class PlainPass {
 public:
  /// `target`: format of the targets. `slots`: as many frames may be under way.
  PlainPass(const Device& device, VkFormat target, std::size_t slots);

  /// Whether the processor makes views here: devices on the CPU, and targets of 8-bit codes.
  bool works() const { return works_; }
  bool blue_first() const { return blue_first_; }

  /// A frame, with nothing in it yet. What was recorded with this slot before must be done.
  void begin(std::size_t slot);
  /// These pixels of the target show the view; no others of the frame have them.
  void add(const PlainView& view, const Rect& pixels);
  /// Outside of rendering: makes the pixels and copies them into the target, which is and stays in
  /// COLOR_ATTACHMENT_OPTIMAL. False when there are none. Errors: device.
  Result<bool> record(VkCommandBuffer commands, VkImage target);

 private:
  struct Part {
    PlainView view;
    Rect pixels;
  };
  const Device& device_;
  bool works_ = false, blue_first_ = false;
  std::vector<Buffer> codes_;  ///< of each slot
  std::vector<Part> parts_;
  std::size_t slot_ = 0;
};

}  // namespace afterglow
