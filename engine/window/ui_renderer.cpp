// SPDX-License-Identifier: MIT
#include "window/ui_renderer.h"

#include <imgui.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "gpu/error.h"

namespace afterglow {

namespace {

/// Room for `bytes`, and some to spare: interfaces grow by little and often.
Result<void> make_room(const Device& device, Buffer& buffer, std::size_t bytes, VkBufferUsageFlags usage) {
  constexpr std::size_t kLeast = std::size_t{64} << 10;
  if (buffer.size() >= bytes && buffer.get() != VK_NULL_HANDLE) return {};
  const std::size_t size = std::bit_ceil(std::max(bytes, kLeast));
  AFTERGLOW_TRY(buffer, Buffer::create(device, size, usage, HostAccess::write, "interface"));
  return {};
}

Size target_size(const ImDrawData& data) {
  return {static_cast<int>(std::lround(data.DisplaySize.x * data.FramebufferScale.x)),
          static_cast<int>(std::lround(data.DisplaySize.y * data.FramebufferScale.y))};
}

}  // namespace

Result<std::unique_ptr<UiRenderer>> UiRenderer::create(const Device& device, VkFormat target, std::size_t slots) {
  std::unique_ptr<UiRenderer> out(new UiRenderer(device));
  AFTERGLOW_TRY(out->pipeline_, UiPipeline::create(device, target));
  AFTERGLOW_CHECK(out->make_set());
  out->slots_.resize(slots);
  return out;
}

Result<void> UiRenderer::make_set() {
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1};
  const VkDescriptorPoolCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, .maxSets = 1, .poolSizeCount = 1, .pPoolSizes = &size};
  VkDescriptorPool pool = VK_NULL_HANDLE;
  AFTERGLOW_VK(device_.vk().vkCreateDescriptorPool(device_.handle(), &info, nullptr, &pool),
               "cannot create a descriptor pool");
  pool_ = DescriptorPoolHandle(device_, pool);
  const VkDescriptorSetLayout layout = pipeline_.set.get();
  const VkDescriptorSetAllocateInfo allocate{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                             .descriptorPool = pool,
                                             .descriptorSetCount = 1,
                                             .pSetLayouts = &layout};
  AFTERGLOW_VK(device_.vk().vkAllocateDescriptorSets(device_.handle(), &allocate, &set_),
               "cannot allocate descriptors");
  return {};
}

Result<void> UiRenderer::take_fonts() {
  unsigned char* pixels = nullptr;
  Size size;
  ImGui::GetIO().Fonts->GetTexDataAsRGBA32(&pixels, &size.width, &size.height);
  const auto bytes = static_cast<std::size_t>(size.area()) * 4;
  AFTERGLOW_TRY(staging_,
                Buffer::create(device_, bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, HostAccess::write, "glyphs"));
  std::memcpy(staging_.data(), pixels, bytes);
  AFTERGLOW_CHECK(staging_.memory().flush());
  AFTERGLOW_TRY(atlas_,
                GpuImage::create(device_, {.name = "glyphs",
                                           .size = size,
                                           .format = VK_FORMAT_R8G8B8A8_UNORM,
                                           .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT}));
  const VkDescriptorImageInfo image{pipeline_.sampler.get(), atlas_.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                   .dstSet = set_,
                                   .dstBinding = 0,
                                   .descriptorCount = 1,
                                   .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                   .pImageInfo = &image};
  device_.vk().vkUpdateDescriptorSets(device_.handle(), 1, &write, 0, nullptr);
  pieces_.take_atlas(size);
  pending_ = true;
  return {};
}

void UiRenderer::copy_to_atlas(VkCommandBuffer commands, VkBuffer from, std::span<const VkBufferImageCopy> parts,
                               VkImageLayout before) const {
  const bool was_read = before == VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  const auto into = image_barrier(
      atlas_.get(), was_read ? VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT : VK_PIPELINE_STAGE_2_NONE, 0, before,
      VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
  record_barriers(device_, commands, &into, 1);
  device_.vk().vkCmdCopyBufferToImage(commands, from, atlas_.get(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                      static_cast<std::uint32_t>(parts.size()), parts.data());
  const auto ready = image_barrier(atlas_.get(), VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                                   VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  record_barriers(device_, commands, &ready, 1);
}

void UiRenderer::upload_atlas(VkCommandBuffer commands) {
  const Size size = atlas_.desc().size;
  const VkBufferImageCopy copy{
      .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
      .imageExtent = {static_cast<std::uint32_t>(size.width), static_cast<std::uint32_t>(size.height), 1}};
  copy_to_atlas(commands, staging_.get(), {&copy, 1}, VK_IMAGE_LAYOUT_UNDEFINED);
  pending_ = false;
}

Result<void> UiRenderer::upload_parts(VkCommandBuffer commands, Slot& slot, std::span<const Rect> changed) {
  unsigned char* pixels = nullptr;
  int width = 0, height = 0;
  ImGui::GetIO().Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
  std::size_t bytes = 0;
  for (const Rect& part : changed) bytes += static_cast<std::size_t>(part.size().area()) * 4;
  AFTERGLOW_CHECK(make_room(device_, slot.parts, bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT));
  std::vector<VkBufferImageCopy> copies;
  std::size_t at = 0;
  for (const Rect& part : changed) {
    copies.push_back(
        {.bufferOffset = at,
         .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
         .imageOffset = {part.x, part.y, 0},
         .imageExtent = {static_cast<std::uint32_t>(part.width), static_cast<std::uint32_t>(part.height), 1}});
    const auto row = static_cast<std::size_t>(part.width) * 4;
    for (int y = part.y; y < part.y + part.height; ++y, at += row)
      std::memcpy(
          slot.parts.data() + at,
          pixels +
              (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(part.x)) * 4,
          row);
  }
  AFTERGLOW_CHECK(slot.parts.memory().flush());
  copy_to_atlas(commands, slot.parts.get(), copies, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  return {};
}

void UiRenderer::look(const ImDrawData& data, std::span<const Rect> written, WindowTiles& tiles) {
  pieces_.take(data, target_size(data), written);
  pieces_.add_to(tiles);
}

Result<void> UiRenderer::prepare(VkCommandBuffer commands, std::size_t slot_index, const ImDrawData& data,
                                 std::span<const Rect> written, std::span<const Rect> only) {
  Slot& slot = slots_[slot_index];
  if (pending_) upload_atlas(commands);
  if (!written.empty()) AFTERGLOW_CHECK(upload_parts(commands, slot, written));
  pieces_.write(only, draws_, indices_);
  if (draws_.empty()) return {};
  const auto vertex_count = static_cast<std::size_t>(data.TotalVtxCount);
  AFTERGLOW_CHECK(
      make_room(device_, slot.vertices, vertex_count * sizeof(ImDrawVert), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT));
  AFTERGLOW_CHECK(
      make_room(device_, slot.indices, indices_.size() * sizeof(ImDrawIdx), VK_BUFFER_USAGE_INDEX_BUFFER_BIT));
  std::byte* vertices = slot.vertices.data();
  for (int i = 0; i < data.CmdListsCount; ++i) {
    const ImDrawList& list = *data.CmdLists[i];
    const auto vertex_bytes = static_cast<std::size_t>(list.VtxBuffer.Size) * sizeof(ImDrawVert);
    std::memcpy(vertices, list.VtxBuffer.Data, vertex_bytes);
    vertices += vertex_bytes;
  }
  std::memcpy(slot.indices.data(), indices_.data(), indices_.size() * sizeof(ImDrawIdx));
  AFTERGLOW_CHECK(slot.vertices.memory().flush());
  AFTERGLOW_CHECK(slot.indices.memory().flush());
  return {};
}

void UiRenderer::record(VkCommandBuffer commands, std::size_t slot_index, const ImDrawData& data) const {
  const Size target = target_size(data);
  if (draws_.empty()) return;
  const Slot& slot = slots_[slot_index];
  device_.begin_label(commands, "interface");
  device_.vk().vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_.pipeline.get());
  device_.vk().vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_.layout.get(), 0, 1, &set_,
                                       0, nullptr);
  const VkBuffer vertices = slot.vertices.get();
  const VkDeviceSize start = 0;
  device_.vk().vkCmdBindVertexBuffers(commands, 0, 1, &vertices, &start);
  device_.vk().vkCmdBindIndexBuffer(commands, slot.indices.get(), 0,
                                    sizeof(ImDrawIdx) == 2 ? VK_INDEX_TYPE_UINT16 : VK_INDEX_TYPE_UINT32);
  const VkViewport viewport{0, 0, static_cast<float>(target.width), static_cast<float>(target.height), 0, 1};
  device_.vk().vkCmdSetViewport(commands, 0, 1, &viewport);
  UiPush push;
  push.scale = {2 / data.DisplaySize.x, 2 / data.DisplaySize.y};
  push.shift = {-1 - data.DisplayPos.x * push.scale[0], -1 - data.DisplayPos.y * push.scale[1]};
  device_.vk().vkCmdPushConstants(commands, pipeline_.layout.get(), VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof push, &push);

  for (const UiDraw& draw : draws_) {
    const VkRect2D scissor{
        {draw.scissor.x, draw.scissor.y},
        {static_cast<std::uint32_t>(draw.scissor.width), static_cast<std::uint32_t>(draw.scissor.height)}};
    device_.vk().vkCmdSetScissor(commands, 0, 1, &scissor);
    device_.vk().vkCmdDrawIndexed(commands, draw.count, 1, draw.first_index, draw.vertex_offset, 0);
  }
  device_.end_label(commands);
}

}  // namespace afterglow
