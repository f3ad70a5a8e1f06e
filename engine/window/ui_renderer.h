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
  /// Writes what `record` will draw; what was recorded with `slot` before must be done. Outside of rendering: also
  /// uploads a new atlas, or those parts of it that have changed since. Errors: device.
  Result<void> prepare(VkCommandBuffer commands, std::size_t slot, const ImDrawData& data,
                       std::span<const Rect> changed = {});
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
};

}  // namespace afterglow
