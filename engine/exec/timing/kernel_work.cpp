// SPDX-License-Identifier: MIT
#include "exec/timing/kernel_work.h"

#include "exec/record.h"

namespace afterglow {
namespace {

/// Between runs: what one has written, the next may write again; readers of the source need not wait for each other.
VkImageMemoryBarrier2 again(const ImageBinding& target) {
  return image_barrier(target.image, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                       VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                       VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                       VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
}

}  // namespace

Result<KernelWork> KernelWork::create(const Device& device, KernelCompiler& compiler, const KernelDesc& kernel,
                                      const ImageBinding& source, const ImageBinding& target, const std::string& name) {
  KernelWork out;
  AFTERGLOW_TRY(out.compiled_, compiler.compile(kernel));
  AFTERGLOW_TRY(out.pipelines_, KernelPipelines::create(device, {out.compiled_}, {name}, target.format));
  AFTERGLOW_TRY(out.sampler_,
                create_sampler(device, kernel.config.hardware_filter ? VK_FILTER_LINEAR : VK_FILTER_NEAREST));
  const DrawLayout& layout = out.pipelines_.layout(out.compiled_);
  AFTERGLOW_TRY(out.descriptors_,
                Descriptors::create(device, {{.layout = layout.set.get(), .images = descriptor_types(out.compiled_)}}));
  out.descriptors_.write_image(0, 0, source.view, VK_IMAGE_LAYOUT_GENERAL, out.sampler_.get());
  const KernelCommands commands{.name = name,
                                .pipeline = out.pipelines_.pipeline(0),
                                .layout = layout.pipeline.get(),
                                .targets = {target.view},
                                .target_size = target.size,
                                .first_image_size = source.size,
                                .part = {0, 0, target.size.width, target.size.height},
                                .barriers = {.images = {again(target)}}};
  AFTERGLOW_TRY(out.work_, TimedWork::create(device, [&](VkCommandBuffer buffer) {
                  record_kernel(device, buffer, commands, out.descriptors_.set(0), {});
                }));
  return out;
}

Result<BufferCopy> BufferCopy::create(const Device& device, VkDeviceSize bytes) {
  BufferCopy out;
  AFTERGLOW_TRY(out.from_,
                Buffer::create(device, bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                               HostAccess::none, "copied from"));
  AFTERGLOW_TRY(out.to_,
                Buffer::create(device, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, HostAccess::none, "copied to"));
  // Memory that nothing has written may be no memory at all.
  AFTERGLOW_TRY(TimedWork fill, TimedWork::create(device, [&](VkCommandBuffer commands) {
                  device.vk().vkCmdFillBuffer(commands, out.from_.get(), 0, VK_WHOLE_SIZE, 0x3f000000);
                }));
  AFTERGLOW_CHECK(fill.run());
  AFTERGLOW_TRY(out.work_, TimedWork::create(device, [&](VkCommandBuffer commands) {
                  const VkBufferCopy all{.size = bytes};
                  device.vk().vkCmdCopyBuffer(commands, out.from_.get(), out.to_.get(), 1, &all);
                }));
  return out;
}

}  // namespace afterglow
