// SPDX-License-Identifier: MIT
// The images of a window: acquired, drawn, presented; made anew when the window changes.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/geometry.h"
#include "gpu/handle.h"
#include "gpu/surface.h"
#include "gpu/swapchain_choice.h"

namespace afterglow {

struct SwapchainOptions {
  bool tearing = false;   ///< present at once instead of with the display's refresh, where the surface can
  bool readback = false;  ///< images can be copied from (for screenshots), where the surface can
};

/// A target that is ready to be drawn.
struct PresentTarget {
  VkImage image = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
  VkFormat format = VK_FORMAT_UNDEFINED;
  Size size;
  /// Below Swapchain::kFramesInFlight: nothing that was drawn in this slot before is still running, so that what a
  /// drawer keeps for each slot may be written.
  std::size_t slot = 0;
  std::size_t index = 0;  ///< of the image among those of the window
  bool kept = false;      ///< the image has the pixels that were drawn into it last, with the same size; else anything
  bool takes_copies = false;  ///< it may be copied to
};

/// Drawing thread alone. Draws at most kFramesInFlight frames ahead of the device. The Device (which must have a
/// Presentation) and the window must outlive it.
class Swapchain {
 public:
  static constexpr std::size_t kFramesInFlight = 2;

  /// Errors: device (no surface, no format that we can present in).
  static Result<std::unique_ptr<Swapchain>> create(Device& device, const SwapchainOptions& options = {});
  ~Swapchain();  ///< waits for the device
  Swapchain(const Swapchain&) = delete;
  Swapchain& operator=(const Swapchain&) = delete;

  /// Records the frame: `target.image` arrives and must be left in COLOR_ATTACHMENT_OPTIMAL.
  using Draw = std::function<void(VkCommandBuffer, const PresentTarget&)>;
  enum class Drawn {
    yes,
    minimised,  ///< the window has no area; nothing was drawn
    later,      ///< the window is changing, or its images are all with the display: draw again soon
  };
  /// Draws and presents one frame. `window`: size of the window's framebuffer, in pixels. Blocks while the device is
  /// kFramesInFlight frames behind or, with FIFO, the display's queue is full. A lost surface is made anew once.
  /// Errors: device (lost, or the surface cannot be made again).
  Result<Drawn> draw(Size window, const Draw& draw);

  VkFormat format() const { return format_.format; }  ///< the same for the life of the Swapchain
  bool readable() const { return readable_; }         ///< images may be copied from
  /// The size of the last frame, as long as a window of that size shows it: none while the next frame would have to be
  /// drawn whatever it shows.
  std::optional<Size> shown(Size window) const;
  /// Blocks until all frames drawn so far are done. Not for steady frames. Errors: device.
  Result<void> finish();
  /// Destroys what is no longer needed by frames in flight when they are done: for objects that drawers replace.
  void retire(std::shared_ptr<void> object);

  struct Counters {
    std::uint64_t presented = 0;           ///< frames
    std::uint64_t made = 0, surfaces = 0;  ///< swapchains and surfaces, ever
    std::uint64_t retired = 0;             ///< swapchains that wait for their last presentation
  };
  Counters counters() const;

 private:
  struct Image {
    VkImage image = VK_NULL_HANDLE;
    ImageViewHandle view;
    SemaphoreHandle drawn;  ///< waited for by the presentation of this very image: free again once it is acquired again
    bool presented = false;  ///< at least once
  };
  /// One VkSwapchainKHR with its images. Destroyed when no frame draws to it and no presentation waits on it.
  struct Chain {
    SwapchainHandle swapchain;
    Size size;
    std::vector<Image> images;
  };
  /// What one frame in flight needs.
  struct Slot {
    CommandPoolHandle pool;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    FenceHandle done;
    SemaphoreHandle acquired;
    bool pending = false;
    std::uint64_t frame = 0;         ///< number of the frame that was submitted last
    std::uint64_t proves_chain = 0;  ///< when done: presentations of all chains before this one are over
  };
  struct Retired {
    std::shared_ptr<void> object;
    std::uint64_t frame = 0;  ///< not needed once this frame is done
    std::uint64_t chain = 0;  ///< of a chain: and presentations of this one are over; else 0
  };

  explicit Swapchain(Device& device) : device_(device) {}
  Result<void> make_slots();
  Result<void> make_surface();
  Result<bool> make_chain(Size window, bool surface_may_be_lost = true);
  Result<void> fill_chain(Chain& chain);
  Result<void> wait(Slot& slot);
  Result<std::optional<std::uint32_t>> acquire(Slot& slot);
  Result<void> submit(Slot& slot, const Image& image, std::size_t index, const Draw& draw);
  Result<void> present(Image& image, std::uint32_t index);
  Result<void> lose_surface();
  void note_suboptimal();
  void retire_chain();
  Result<void> drain();
  void release();

  Device& device_;
  SwapchainOptions options_;
  Surface surface_;
  VkSurfaceFormatKHR format_{};
  bool takes_copies_ = false;
  bool readable_ = false;
  bool stale_ = false;  ///< the chain can present no more, or no longer well
  Size suboptimal_at_;  ///< size of the last chain that was made anew for being suboptimal
  Size made_for_;       ///< the window's size when the chain was made
  std::array<Slot, kFramesInFlight> slots_;
  std::size_t next_slot_ = 0;
  std::shared_ptr<Chain> chain_;
  std::uint64_t chain_number_ = 0, frame_number_ = 0, frames_done_ = 0, proven_chain_ = 0;
  std::vector<Retired> retired_;
  Counters counters_;
};

}  // namespace afterglow
