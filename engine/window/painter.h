// SPDX-License-Identifier: MIT
// Puts picture and interface into the window.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "gpu/swapchain.h"
#include "window/ui_renderer.h"
#include "window/view_pass.h"

namespace afterglow {

/// Drawing thread alone. The Device (with a Presentation) must outlive it.
class Painter {
 public:
  /// Errors: device.
  static Result<std::unique_ptr<Painter>> create(Device& device, const SwapchainOptions& options);

  /// After the interface's fonts have changed; waits for the frames before. Errors: device.
  Result<void> take_fonts();
  /// The display that pictures are shown on from here on; waits for the frames before. Errors: device.
  Result<void> take_display(const DisplayTable& table);
  /// Waits until the frames drawn so far are done: what they read may be written then. Errors: device.
  Result<void> finish() { return swapchain_->finish(); }
  /// One frame: the picture (none: background alone), then the interface over it. `window`: size of the frame buffer.
  /// Images of `view` must be readable by fragment shaders in what is submitted from here on. Errors: device.
  /// `changed`: parts of the interface's atlas.
  Result<Swapchain::Drawn> paint(Size window, std::span<const ViewFrame> views, const ImDrawData& interface,
                                 std::span<const Rect> changed = {});
  /// The next frame that is painted goes to this file too (PNG, or what else the writer knows).
  void capture(const std::filesystem::path& file) { capture_ = file; }

  const Swapchain& swapchain() const { return *swapchain_; }

 private:
  explicit Painter(Device& device) : device_(device) {}
  Result<void> record(VkCommandBuffer commands, const PresentTarget& target, std::span<const ViewFrame> views,
                      const ImDrawData& interface, std::span<const Rect> changed);
  void record_copy(VkCommandBuffer commands, const PresentTarget& target, const Buffer& to) const;
  Result<void> write_capture(const Buffer& pixels, Size size);

  Device& device_;
  std::unique_ptr<ViewPass> view_pass_;
  std::unique_ptr<UiRenderer> ui_;
  std::filesystem::path capture_;
  std::unique_ptr<Swapchain> swapchain_;  // last: it waits before what its frames use goes
};

}  // namespace afterglow
