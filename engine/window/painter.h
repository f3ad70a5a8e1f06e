// SPDX-License-Identifier: MIT
// Puts picture and interface into the window.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "gpu/swapchain.h"
#include "window/paint_check.h"
#include "window/ui_renderer.h"
#include "window/view_pass.h"
#include "window/window_tiles.h"

namespace afterglow {

/// Drawing thread alone. The Device (with a Presentation) must outlive it.
class Painter {
 public:
  /// `check`: each frame that keeps pixels is drawn wholly too, beside the window, and compared byte by byte; one that
  /// differs is an error. It takes `readback`. Errors: device.
  static Result<std::unique_ptr<Painter>> create(Device& device, const SwapchainOptions& options, bool check = false);

  /// After the interface's fonts have changed; waits for the frames before. Errors: device.
  Result<void> take_fonts();
  /// The display that pictures are shown on from here on; waits for the frames before. Errors: device.
  Result<void> take_display(const DisplayTable& table);
  /// Waits until the frames drawn so far are done: what they read may be written then. Errors: device.
  Result<void> finish() { return swapchain_->finish(); }
  /// One frame: the picture (none: background alone), then the interface over it. `window`: size of the frame buffer.
  /// Devices on the CPU leave alone what an image of the window shows already; the pixels are the same.
  /// Images of `view` must be readable by fragment shaders in what is submitted from here on. Errors: device.
  /// `written`: parts of the interface's atlas that have changed.
  /// A frame that looks as the last one is neither drawn nor presented; the answer is `yes` all the same.
  Result<Swapchain::Drawn> paint(Size window, std::span<const ViewFrame> views, const ImDrawData& interface,
                                 std::span<const Rect> written = {});
  /// What the window shows was lost (another one lay over it): the next frame is presented whatever it shows.
  void expose() { on_screen_.clear(); }
  /// The next frame that is painted goes to this file too (PNG, or what else the writer knows).
  void capture(const std::filesystem::path& file) { capture_ = file; }
  /// What has come of it, once: the file. Errors: io, device (the window's images cannot be read).
  std::optional<Result<std::filesystem::path>> take_captured() { return std::exchange(captured_, std::nullopt); }

  const Swapchain& swapchain() const { return *swapchain_; }

 private:
  explicit Painter(Device& device) : device_(device), keeps_(device.is_cpu()) {}
  Result<void> record(VkCommandBuffer commands, const PresentTarget& target, std::span<const ViewFrame> views,
                      const ImDrawData& interface, std::span<const Rect> written);
  void look(Size size, std::span<const ViewFrame> views, const ImDrawData& interface, std::span<const Rect> written);
  Result<void> record_parts(VkCommandBuffer commands, const PresentTarget& target, std::span<const ViewFrame> views,
                            const ImDrawData& interface, std::span<const Rect> only);
  Result<void> record_check(VkCommandBuffer commands, const PresentTarget& target, std::span<const ViewFrame> views,
                            const ImDrawData& interface);
  Result<std::filesystem::path> write_capture(const Buffer& pixels, Size size);

  Device& device_;
  std::unique_ptr<ViewPass> view_pass_;
  std::unique_ptr<UiRenderer> ui_;
  std::filesystem::path capture_;
  std::optional<Result<std::filesystem::path>> captured_;
  const bool keeps_;   ///< drivers on the CPU: there a pixel costs more than finding out that it need not be drawn
  WindowTiles tiles_;  ///< of the frame that is painted
  Size looked_;        ///< size of the frame that `tiles_` are of; empty: of none yet
  std::vector<std::vector<std::uint64_t>> shown_;  ///< what each image of the window has
  std::vector<std::uint64_t> on_screen_;           ///< what the last frame has; empty: not known
  std::vector<ViewFrame> views_;                   ///< of the frame before, without what changes with each picture
  std::uint64_t look_ = 0;                         ///< another number when `views_` are others
  std::uint64_t glyphs_ = 0;                       ///< another number when all that the window shows may look different
  std::unique_ptr<PaintCheck> check_;              ///< none: nobody asked for it
  std::unique_ptr<Swapchain> swapchain_;           // last: it waits before what its frames use goes
};

}  // namespace afterglow
