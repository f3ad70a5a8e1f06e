// SPDX-License-Identifier: MIT
#include "exec/timing/compute_copy.h"

#include <array>

#include "exec/timing/copy_compute.h"
#include "gpu/error.h"
#include "gpu/pipeline.h"

namespace afterglow {
namespace {

constexpr std::uint32_t kGroupWidth = 16, kGroupHeight = 8;

Result<SetLayoutHandle> make_set_layout(const Device& device) {
  std::array<VkDescriptorSetLayoutBinding, 2> bindings{};
  bindings[0] = {.binding = 0,
                 .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                 .descriptorCount = 1,
                 .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT,
                 .pImmutableSamplers = nullptr};
  bindings[1] = {.binding = 1,
                 .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
                 .descriptorCount = 1,
                 .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT,
                 .pImmutableSamplers = nullptr};
  const VkDescriptorSetLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                             .bindingCount = bindings.size(),
                                             .pBindings = bindings.data()};
  VkDescriptorSetLayout layout = VK_NULL_HANDLE;
  AFTERGLOW_VK(device.vk().vkCreateDescriptorSetLayout(device.handle(), &info, nullptr, &layout),
               "cannot create a descriptor layout");
  return SetLayoutHandle(device, layout);
}

Result<PipelineHandle> make_pipeline(const Device& device, VkPipelineLayout layout) {
  AFTERGLOW_TRY(const ShaderModuleHandle module, create_shader_module(device, kCopyCompute, "compute copy"));
  const VkComputePipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                                         .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                                   .pNext = nullptr,
                                                   .flags = 0,
                                                   .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                                                   .module = module.get(),
                                                   .pName = "main",
                                                   .pSpecializationInfo = nullptr},
                                         .layout = layout,
                                         .basePipelineIndex = -1};
  VkPipeline pipeline = VK_NULL_HANDLE;
  AFTERGLOW_VK(
      device.vk().vkCreateComputePipelines(device.handle(), device.pipeline_cache(), 1, &info, nullptr, &pipeline),
      "cannot create the pipeline of 'compute copy'");
  return PipelineHandle(device, pipeline);
}

Result<DescriptorPoolHandle> make_pool(const Device& device) {
  constexpr std::array kSizes{VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1},
                              VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1}};
  const VkDescriptorPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                        .maxSets = 1,
                                        .poolSizeCount = kSizes.size(),
                                        .pPoolSizes = kSizes.data()};
  VkDescriptorPool pool = VK_NULL_HANDLE;
  AFTERGLOW_VK(device.vk().vkCreateDescriptorPool(device.handle(), &info, nullptr, &pool),
               "cannot create a descriptor pool");
  return DescriptorPoolHandle(device, pool);
}

Result<VkDescriptorSet> make_set(const Device& device, VkDescriptorPool pool, VkDescriptorSetLayout layout,
                                 const VkDescriptorImageInfo& source, const VkDescriptorImageInfo& target) {
  const VkDescriptorSetAllocateInfo allocate{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                             .descriptorPool = pool,
                                             .descriptorSetCount = 1,
                                             .pSetLayouts = &layout};
  VkDescriptorSet set = VK_NULL_HANDLE;
  AFTERGLOW_VK(device.vk().vkAllocateDescriptorSets(device.handle(), &allocate, &set), "cannot allocate descriptors");
  std::array<VkWriteDescriptorSet, 2> writes{};
  for (std::uint32_t i = 0; i < writes.size(); ++i)
    writes[i] = {
        .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
        .dstSet = set,
        .dstBinding = i,
        .descriptorCount = 1,
        .descriptorType = i == 0 ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
        .pImageInfo = i == 0 ? &source : &target};
  device.vk().vkUpdateDescriptorSets(device.handle(), writes.size(), writes.data(), 0, nullptr);
  return set;
}

}  // namespace

Result<ComputeCopy> ComputeCopy::create(const Device& device, const ImageBinding& source) {
  ComputeCopy out;
  AFTERGLOW_TRY(out.target_,
                GpuImage::create(device, {.name = "compute copy",
                                          .size = source.size,
                                          .format = source.format,
                                          .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT}));
  AFTERGLOW_TRY(out.sampler_, create_sampler(device, VK_FILTER_NEAREST));
  AFTERGLOW_TRY(out.set_layout_, make_set_layout(device));
  const VkDescriptorSetLayout set_layout = out.set_layout_.get();
  const VkPipelineLayoutCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO, .setLayoutCount = 1, .pSetLayouts = &set_layout};
  VkPipelineLayout layout = VK_NULL_HANDLE;
  AFTERGLOW_VK(device.vk().vkCreatePipelineLayout(device.handle(), &info, nullptr, &layout),
               "cannot create a pipeline layout");
  out.layout_ = PipelineLayoutHandle(device, layout);
  AFTERGLOW_TRY(out.pipeline_, make_pipeline(device, layout));
  AFTERGLOW_TRY(out.pool_, make_pool(device));
  AFTERGLOW_TRY(const VkDescriptorSet set, make_set(device, out.pool_.get(), set_layout,
                                                    {out.sampler_.get(), source.view, VK_IMAGE_LAYOUT_GENERAL},
                                                    {VK_NULL_HANDLE, out.target_.view(), VK_IMAGE_LAYOUT_GENERAL}));
  AFTERGLOW_TRY(
      out.work_, TimedWork::create(device, [&](VkCommandBuffer commands) {
        const auto ready =
            image_barrier(out.target_.get(), VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_WRITE_BIT,
                          VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                          VK_ACCESS_2_SHADER_WRITE_BIT, VK_IMAGE_LAYOUT_GENERAL);
        record_barriers(device, commands, &ready, 1);
        device.vk().vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, out.pipeline_.get());
        device.vk().vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &set, 0, nullptr);
        device.vk().vkCmdDispatch(
            commands, (static_cast<std::uint32_t>(source.size.width) + kGroupWidth - 1) / kGroupWidth,
            (static_cast<std::uint32_t>(source.size.height) + kGroupHeight - 1) / kGroupHeight, 1);
      }));
  return out;
}

}  // namespace afterglow
