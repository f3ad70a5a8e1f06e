// SPDX-License-Identifier: MIT
#include "window/painter.h"

#include <imgui.h>

#include <array>
#include <utility>

#include "image/writer.h"

namespace afterglow {

namespace {

/// At which bytes of a pixel red, green and blue lie; none: no 8-bit codes.
std::optional<std::array<std::size_t, 3>> code_order(VkFormat format) {
  switch (format) {
    case VK_FORMAT_B8G8R8A8_UNORM:
    case VK_FORMAT_B8G8R8A8_SRGB:
      return std::array<std::size_t, 3>{2, 1, 0};
    case VK_FORMAT_R8G8B8A8_UNORM:
    case VK_FORMAT_R8G8B8A8_SRGB:
    case VK_FORMAT_A8B8G8R8_UNORM_PACK32:
    case VK_FORMAT_A8B8G8R8_SRGB_PACK32:
      return std::array<std::size_t, 3>{0, 1, 2};
    default:
      return std::nullopt;
  }
}

}  // namespace

Result<std::unique_ptr<Painter>> Painter::create(Device& device, const SwapchainOptions& options) {
  std::unique_ptr<Painter> out(new Painter(device));
  AFTERGLOW_TRY(out->swapchain_, Swapchain::create(device, options));
  const VkFormat format = out->swapchain_->format();
  AFTERGLOW_TRY(out->view_pass_, ViewPass::create(device, format, Swapchain::kFramesInFlight));
  AFTERGLOW_TRY(out->ui_, UiRenderer::create(device, format, Swapchain::kFramesInFlight));
  AFTERGLOW_CHECK(out->ui_->take_fonts());
  return out;
}

Result<void> Painter::take_fonts() {
  AFTERGLOW_CHECK(swapchain_->finish());
  return ui_->take_fonts();
}

Result<void> Painter::take_display(const DisplayTable& table) {
  AFTERGLOW_CHECK(swapchain_->finish());
  return view_pass_->take_table(table);
}

Result<void> Painter::record(VkCommandBuffer commands, const PresentTarget& target, std::span<const ViewFrame> views,
                             const ImDrawData& interface, std::span<const Rect> changed) {
  AFTERGLOW_CHECK(ui_->prepare(commands, target.slot, interface, changed));
  view_pass_->prepare(commands);
  const VkRenderingAttachmentInfo color{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                        .imageView = target.view,
                                        .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                        .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                        .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                        .clearValue = {.color = {.float32 = {0.1f, 0.1f, 0.1f, 1}}}};
  const VkRenderingInfo rendering{
      .sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
      .renderArea = {{0, 0},
                     {static_cast<std::uint32_t>(target.size.width), static_cast<std::uint32_t>(target.size.height)}},
      .layerCount = 1,
      .colorAttachmentCount = 1,
      .pColorAttachments = &color};
  device_.vk().vkCmdBeginRendering(commands, &rendering);
  const auto viewed = view_pass_->record(commands, target.slot, views);
  ui_->record(commands, target.slot, interface);
  device_.vk().vkCmdEndRendering(commands);
  return viewed;
}

void Painter::record_copy(VkCommandBuffer commands, const PresentTarget& target, const Buffer& to) const {
  const auto into =
      image_barrier(target.image, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                    VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                    VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
  record_barriers(device_, commands, &into, 1);
  const VkBufferImageCopy copy{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                               .imageExtent = {static_cast<std::uint32_t>(target.size.width),
                                               static_cast<std::uint32_t>(target.size.height), 1}};
  device_.vk().vkCmdCopyImageToBuffer(commands, target.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to.get(), 1, &copy);
  const auto back = image_barrier(target.image, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                                  VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                  0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
  record_barriers(device_, commands, &back, 1);
  const VkMemoryBarrier2 to_host{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                 .srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT,
                                 .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                 .dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT,
                                 .dstAccessMask = VK_ACCESS_2_HOST_READ_BIT};
  const VkDependencyInfo dependency{
      .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &to_host};
  device_.vk().vkCmdPipelineBarrier2(commands, &dependency);
}

Result<Swapchain::Drawn> Painter::paint(Size window, std::span<const ViewFrame> views, const ImDrawData& interface,
                                        std::span<const Rect> changed) {
  const bool capture = !capture_.empty() && code_order(swapchain_->format()).has_value();
  Result<void> recorded;
  Buffer pixels;
  Size size;
  AFTERGLOW_TRY(const auto drawn, swapchain_->draw(window, [&](VkCommandBuffer commands, const PresentTarget& target) {
    recorded = record(commands, target, views, interface, changed);
    if (!recorded || !capture || !swapchain_->readable()) return;
    auto buffer = Buffer::create(device_, static_cast<VkDeviceSize>(target.size.area()) * 4,
                                 VK_BUFFER_USAGE_TRANSFER_DST_BIT, HostAccess::read, "capture");
    if (!buffer) {
      recorded = std::move(buffer).error();
      return;
    }
    pixels = std::move(*buffer);
    size = target.size;
    record_copy(commands, target, pixels);
  }));
  AFTERGLOW_CHECK(std::move(recorded));
  if (size.area() > 0) AFTERGLOW_CHECK(write_capture(pixels, size));
  return drawn;
}

Result<void> Painter::write_capture(const Buffer& pixels, Size size) {
  AFTERGLOW_CHECK(swapchain_->finish());
  pixels.memory().invalidate();
  const auto order = *code_order(swapchain_->format());
  Picture picture;
  picture.color = Image(size.width, size.height, 4);
  picture.data_window = picture.display_window = {0, 0, size.width, size.height};
  picture.unorm8.resize(static_cast<std::size_t>(size.area()) * 4, 255);
  for (std::size_t i = 0; i < picture.unorm8.size(); i += 4) {
    for (std::size_t c = 0; c < 3; ++c) picture.unorm8[i + c] = static_cast<std::uint8_t>(pixels.data()[i + order[c]]);
  }
  Diagnostics nowhere;
  const std::filesystem::path file = std::exchange(capture_, {});
  return write_picture(picture, file, {.type = SampleType::uint8}, nowhere);
}

}  // namespace afterglow
