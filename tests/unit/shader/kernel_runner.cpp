// SPDX-License-Identifier: MIT
#include "kernel_runner.h"

#include <cstring>
#include <glm/gtc/packing.hpp>
#include <stdexcept>

#include "gpu/fullscreen_vertex.h"
#include "gpu/image.h"
#include "gpu/pipeline.h"
#include "gpu/row_targets.h"

namespace afterglow {
namespace {

template <class T>
T need(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().text());
  return std::move(result).value();
}

void need(VkResult result) {
  if (result != VK_SUCCESS) throw std::runtime_error("a Vulkan call failed");
}

constexpr auto kRead = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
constexpr auto kDraw = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
constexpr auto kCopy = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;

GpuImage upload(const Device& device, const TestImage& image) {
  auto gpu = need(GpuImage::create(
      device,
      {.name = "input", .size = image.size, .usage = VK_IMAGE_USAGE_SAMPLED_BIT, .tiling = VK_IMAGE_TILING_LINEAR},
      HostAccess::write));
  for (int y = 0; y < image.size.height; ++y)
    std::memcpy(gpu.row(y), image.at(0, y), static_cast<std::size_t>(image.size.width) * 16);
  EXPECT_TRUE(gpu.memory().flush());
  return gpu;
}

}  // namespace

struct KernelRunner::Pipeline {
  DrawLayout layout;
  ShaderModuleHandle vertex, fragment;
  PipelineHandle pipeline;
};

const KernelRunner::Pipeline& KernelRunner::pipeline(const CompiledKernel& kernel, VkFormat format) {
  auto& made = pipelines_[{kernel.hash, format, kernel.flat_parameters}];
  if (made) return *made;
  made = std::make_unique<Pipeline>();
  std::vector<VkDescriptorType> types(kernel.images.size(), VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER);
  if (!kernel.loops.empty()) types.push_back(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
  made->layout = need(create_draw_layout(
      *device_, {.block = kernel.block_size > 0, .images = types, .push_bytes = kPushConstantBytes, .vertex = true}));
  std::optional<FlatParameters> flat;
  if (kernel.flat_parameters) flat = flat_parameters(kernel.spirv, 16);
  made->vertex = need(create_shader_module(
      *device_, flat ? std::span<const std::uint32_t>(flat->vertex) : kFullscreenVertex, "vertex"));
  made->fragment = need(create_shader_module(*device_, flat ? flat->fragment : kernel.spirv, "kernel"));
  made->pipeline = need(create_draw_pipeline(*device_, made->layout, made->vertex.get(), made->fragment.get(),
                                             {format, kernel.rows}, "kernel"));
  return *made;
}

KernelRunner::KernelRunner() {
  setenv("XDG_RUNTIME_DIR", "/tmp", 0);
  Diagnostics diagnostics;
  device_ = need(Device::create({.device = "auto", .validate = true}, diagnostics));
  const VkCommandPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                     .queueFamilyIndex = device_->queue_family()};
  need(device_->vk().vkCreateCommandPool(device_->handle(), &info, nullptr, &pool_));
}

KernelRunner::~KernelRunner() { device_->vk().vkDestroyCommandPool(device_->handle(), pool_, nullptr); }

TestImage KernelRunner::run(const CompiledKernel& kernel, const std::vector<TestImage>& images, Size target,
                            const std::vector<std::byte>& block, bool half_target) {
  const VkDevice device = device_->handle();
  const VulkanFunctions& vk = device_->vk();
  const VkFormat format = half_target ? VK_FORMAT_R16G16B16A16_SFLOAT : VK_FORMAT_R32G32B32A32_SFLOAT;
  const std::size_t pixel_bytes = half_target ? 8 : 16;
  if (images.size() != kernel.images.size() || block.size() < kernel.block_size)
    throw std::runtime_error("wrong inputs");

  std::vector<GpuImage> inputs;
  for (const auto& image : images) inputs.push_back(upload(*device_, image));
  const bool by_rows = kernel.rows > 1;
  auto unbound = need(
      UnboundImage::create(*device_, {.name = "target",
                                      .size = target,
                                      .format = format,
                                      .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                                      .tiling = by_rows ? VK_IMAGE_TILING_LINEAR : VK_IMAGE_TILING_OPTIMAL}));
  RowTargets rows;
  VkMemoryRequirements needs = unbound.needs();
  if (by_rows) {
    if (RowTargets::possible(*device_, unbound.desc(), kernel.rows) != kernel.rows)
      throw std::runtime_error("the device cannot draw by rows");
    rows = need(RowTargets::create(*device_, unbound, kernel.rows));
    needs = rows.needs();
  }
  const auto output = need(GpuImage::create(*device_, std::move(unbound), needs, HostAccess::none));
  if (by_rows && !rows.bind(*device_, output.memory().get(), 0)) throw std::runtime_error("no targets by rows");
  const VkImageLayout drawn = by_rows ? VK_IMAGE_LAYOUT_GENERAL : kDraw;
  const auto staging = need(Buffer::create(*device_, static_cast<VkDeviceSize>(target.area()) * pixel_bytes,
                                           VK_BUFFER_USAGE_TRANSFER_DST_BIT, HostAccess::read, "staging"));
  const auto uniforms = need(Buffer::create(*device_, std::max<std::size_t>(block.size(), 16),
                                            VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, HostAccess::write, "block"));
  if (!block.empty()) std::memcpy(uniforms.data(), block.data(), block.size());
  EXPECT_TRUE(uniforms.memory().flush());

  const auto loops = need(Buffer::create(*device_, 4, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, HostAccess::read, "loops"));
  std::memset(loops.data(), 0, 4);
  EXPECT_TRUE(loops.memory().flush());

  const auto& [layout, vertex, fragment, pipeline] = this->pipeline(kernel, format);
  const auto sampler = need(create_sampler(*device_, VK_FILTER_LINEAR));

  const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1},
                                        {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 16},
                                        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1}};
  const VkDescriptorPoolCreateInfo pool_info{
      .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, .maxSets = 1, .poolSizeCount = 3, .pPoolSizes = sizes};
  VkDescriptorPool raw_pool = VK_NULL_HANDLE;
  need(vk.vkCreateDescriptorPool(device, &pool_info, nullptr, &raw_pool));
  const DescriptorPoolHandle descriptors(*device_, raw_pool);
  const VkDescriptorSetLayout set_layout = layout.set.get();
  const VkDescriptorSetAllocateInfo set_info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                             .descriptorPool = raw_pool,
                                             .descriptorSetCount = 1,
                                             .pSetLayouts = &set_layout};
  VkDescriptorSet set = VK_NULL_HANDLE;
  need(vk.vkAllocateDescriptorSets(device, &set_info, &set));
  const VkDescriptorBufferInfo buffer{uniforms.get(), 0, VK_WHOLE_SIZE};
  const VkDescriptorBufferInfo word{loops.get(), 0, VK_WHOLE_SIZE};
  std::vector<VkDescriptorImageInfo> views;
  for (const auto& input : inputs) views.push_back({sampler.get(), input.view(), kRead});
  std::vector<VkWriteDescriptorSet> writes;
  const auto write = [&](std::uint32_t binding, VkDescriptorType type) -> VkWriteDescriptorSet& {
    writes.push_back({.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                      .dstSet = set,
                      .dstBinding = binding,
                      .descriptorCount = 1,
                      .descriptorType = type});
    return writes.back();
  };
  if (!kernel.loops.empty())
    write(static_cast<std::uint32_t>(kernel.images.size()) + 1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER).pBufferInfo = &word;
  if (kernel.block_size > 0) write(0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER).pBufferInfo = &buffer;
  for (std::size_t i = 0; i < views.size(); ++i)
    write(static_cast<std::uint32_t>(i) + 1, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER).pImageInfo = &views[i];
  vk.vkUpdateDescriptorSets(device, static_cast<std::uint32_t>(writes.size()), writes.data(), 0, nullptr);

  const VkCommandBufferAllocateInfo allocate{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                             .commandPool = pool_,
                                             .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                             .commandBufferCount = 1};
  VkCommandBuffer commands = VK_NULL_HANDLE;
  need(vk.vkAllocateCommandBuffers(device, &allocate, &commands));
  const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  need(vk.vkBeginCommandBuffer(commands, &begin));
  std::vector<VkImageMemoryBarrier2> barriers;
  for (const auto& input : inputs)
    barriers.push_back(image_barrier(input.get(), VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_WRITE_BIT,
                                     VK_IMAGE_LAYOUT_PREINITIALIZED, VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                                     VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, kRead));
  const auto before = [&](VkImage image) {
    return image_barrier(image, VK_PIPELINE_STAGE_2_NONE, 0, VK_IMAGE_LAYOUT_UNDEFINED,
                         VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                         drawn);
  };
  barriers.push_back(before(output.get()));
  for (int k = 0; k < rows.rows(); ++k) barriers.push_back(before(rows.image(k)));
  record_barriers(*device_, commands, barriers.data(), barriers.size());
  const VkExtent2D size{static_cast<std::uint32_t>(target.width), static_cast<std::uint32_t>(target.height)};
  const VkRect2D area{{0, 0},
                      {size.width, static_cast<std::uint32_t>((target.height + kernel.rows - 1) / kernel.rows)}};
  std::vector<VkRenderingAttachmentInfo> attachments;
  for (const VkImageView view : by_rows ? rows.views() : std::vector{output.view()}) {
    attachments.push_back({.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                           .imageView = view,
                           .imageLayout = drawn,
                           .loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                           .storeOp = VK_ATTACHMENT_STORE_OP_STORE});
  }
  const VkRenderingInfo rendering{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                  .renderArea = area,
                                  .layerCount = 1,
                                  .colorAttachmentCount = static_cast<std::uint32_t>(attachments.size()),
                                  .pColorAttachments = attachments.data()};
  vk.vkCmdBeginRendering(commands, &rendering);
  const VkViewport viewport{0, 0, static_cast<float>(area.extent.width), static_cast<float>(area.extent.height), 0, 1};
  vk.vkCmdSetViewport(commands, 0, 1, &viewport);
  vk.vkCmdSetScissor(commands, 0, 1, &area);
  vk.vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.get());
  vk.vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout.pipeline.get(), 0, 1, &set, 0, nullptr);
  const int push[4] = {target.width, target.height, images.empty() ? 0 : images[0].size.width,
                       images.empty() ? 0 : images[0].size.height};
  vk.vkCmdPushConstants(commands, layout.pipeline.get(), VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                        sizeof push, push);
  vk.vkCmdDraw(commands, 3, 1, 0, 0);
  vk.vkCmdEndRendering(commands);
  const auto to_copy = image_barrier(output.get(), VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                     VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, drawn, VK_PIPELINE_STAGE_2_COPY_BIT,
                                     VK_ACCESS_2_TRANSFER_READ_BIT, kCopy);
  record_barriers(*device_, commands, &to_copy, 1);
  const VkBufferImageCopy region{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                 .imageExtent = {size.width, size.height, 1}};
  vk.vkCmdCopyImageToBuffer(commands, output.get(), kCopy, staging.get(), 1, &region);
  need(vk.vkEndCommandBuffer(commands));
  const VkCommandBufferSubmitInfo buffers{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                          .commandBuffer = commands};
  const VkSubmitInfo2 submit{
      .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2, .commandBufferInfoCount = 1, .pCommandBufferInfos = &buffers};
  need(vk.vkQueueSubmit2(device_->queue(), 1, &submit, VK_NULL_HANDLE));
  need(vk.vkQueueWaitIdle(device_->queue()));
  vk.vkFreeCommandBuffers(device, pool_, 1, &commands);

  EXPECT_TRUE(staging.memory().invalidate());
  TestImage out{target, std::vector<float>(static_cast<std::size_t>(target.area()) * 4)};
  if (!half_target) {
    std::memcpy(out.rgba.data(), staging.data(), out.rgba.size() * sizeof(float));
  } else {
    std::vector<std::uint16_t> halves(out.rgba.size());
    std::memcpy(halves.data(), staging.data(), halves.size() * 2);
    for (std::size_t i = 0; i < halves.size(); ++i) out.rgba[i] = glm::unpackHalf1x16(halves[i]);
  }
  return out;
}

}  // namespace afterglow
