// SPDX-License-Identifier: MIT
// Draws what Dear ImGui wants drawn.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "gpu/image.h"
#include "gpu/memory.h"
#include "gpu/swapchain.h"
#include "window/ui_pieces.h"
#include "window/ui_pipeline.h"

struct ImDrawData;

namespace afterglow {

/// Drawing thread alone. Buffers grow to what an interface needs and stay: steady frames make nothing.
class UiRenderer {
 public:
  /// `slots`: as many frames may be under way. Errors: device.
  static Result<std::unique_ptr<UiRenderer>> create(const Device& device, VkFormat target, std::size_t slots);

  /// Takes the atlas of the current ImGui context's fonts: to be called first, and after fonts have changed. The frames
  /// drawn so far must be done. Errors: device.
  Result<void> take_fonts();
  /// What a frame shows, for `tiles`; before `prepare` and `record` of it. `written`: parts of the atlas that have
  /// changed since the frame before.
  void look(const ImDrawData& data, std::span<const Rect> written, WindowTiles& tiles);
  /// Writes what `record` will draw, within `only` (rectangles that have no pixel in common); what was recorded with
  /// `slot` before must be done. Outside of rendering: also uploads a new atlas, or what was written of it. Errors:
  /// device.
  Result<void> prepare(VkCommandBuffer commands, std::size_t slot, const ImDrawData& data,
                       std::span<const Rect> written, std::span<const Rect> only);
  /// Within vkCmdBeginRendering on one colour target.
  void record(VkCommandBuffer commands, std::size_t slot, const ImDrawData& data) const;

 private:
  struct Slot {
    Buffer vertices, indices, parts;
  };
  explicit UiRenderer(const Device& device) : device_(device) {}
  Result<void> make_set();
  void upload_atlas(VkCommandBuffer commands);
  Result<void> upload_parts(VkCommandBuffer commands, Slot& slot, std::span<const Rect> changed);
  void copy_to_atlas(VkCommandBuffer commands, VkBuffer from, std::span<const VkBufferImageCopy> parts,
                     VkImageLayout before) const;

  const Device& device_;
  UiPipeline pipeline_;
  DescriptorPoolHandle pool_;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
  GpuImage atlas_;
  Buffer staging_;        ///< pixels of the atlas; kept until the next one
  bool pending_ = false;  ///< the atlas has not been uploaded yet
  std::vector<Slot> slots_;
  UiPieces pieces_;
  std::vector<UiDraw> draws_;  ///< of the frame that is prepared, with their indices
  std::vector<ImDrawIdx> indices_;
};

}  // namespace afterglow
