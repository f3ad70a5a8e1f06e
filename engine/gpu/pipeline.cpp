// SPDX-License-Identifier: MIT
#include "gpu/pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "gpu/error.h"
#include "gpu/image.h"

namespace afterglow {

Result<DrawLayout> create_draw_layout(const Device& device, const DrawInterface& interface) {
  const auto& limits = device.properties().limits;
  const VkShaderStageFlags stage = interface.stage();
  const VkShaderStageFlags parameters =
      stage | (interface.vertex ? VkShaderStageFlags{VK_SHADER_STAGE_VERTEX_BIT} : 0u);
  const auto check = [&](VkDescriptorType type, std::uint32_t most) -> Result<void> {
    const auto count = static_cast<std::uint32_t>(std::count(interface.images.begin(), interface.images.end(), type));
    if (count <= most) return {};
    return Error{ErrorKind::device, fmt::format("a kernel reads {} images, the device allows {}", count, most)};
  };
  AFTERGLOW_CHECK(check(VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                        std::min(limits.maxPerStageDescriptorSampledImages, limits.maxPerStageDescriptorSamplers)));
  AFTERGLOW_CHECK(check(VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, limits.maxPerStageDescriptorStorageImages));
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  if (interface.block) {
    bindings.push_back({.binding = 0,
                        .descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
                        .descriptorCount = 1,
                        .stageFlags = parameters,
                        .pImmutableSamplers = nullptr});
  }
  for (std::size_t i = 0; i < interface.images.size(); ++i) {
    bindings.push_back({.binding = static_cast<std::uint32_t>(i) + 1,
                        .descriptorType = interface.images[i],
                        .descriptorCount = 1,
                        .stageFlags = stage,
                        .pImmutableSamplers = nullptr});
  }
  const VkDescriptorSetLayoutCreateInfo set_info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                                 .bindingCount = static_cast<std::uint32_t>(bindings.size()),
                                                 .pBindings = bindings.data()};
  DrawLayout out;
  VkDescriptorSetLayout set = VK_NULL_HANDLE;
  AFTERGLOW_VK(device.vk().vkCreateDescriptorSetLayout(device.handle(), &set_info, nullptr, &set),
               "cannot create a descriptor layout");
  out.set = SetLayoutHandle(device, set);

  const VkPushConstantRange push{parameters, 0, interface.push_bytes};
  const VkPipelineLayoutCreateInfo layout_info{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                               .setLayoutCount = 1,
                                               .pSetLayouts = &set,
                                               .pushConstantRangeCount = interface.push_bytes ? 1u : 0u,
                                               .pPushConstantRanges = &push};
  VkPipelineLayout layout = VK_NULL_HANDLE;
  AFTERGLOW_VK(device.vk().vkCreatePipelineLayout(device.handle(), &layout_info, nullptr, &layout),
               "cannot create a pipeline layout");
  out.pipeline = PipelineLayoutHandle(device, layout);
  return out;
}

Result<ShaderModuleHandle> create_shader_module(const Device& device, std::span<const std::uint32_t> spirv,
                                                const std::string& name) {
  const VkShaderModuleCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = spirv.size_bytes(), .pCode = spirv.data()};
  VkShaderModule module = VK_NULL_HANDLE;
  AFTERGLOW_VK(device.vk().vkCreateShaderModule(device.handle(), &info, nullptr, &module),
               "cannot load the shader of '" + name + "'");
  ShaderModuleHandle out(device, module);
  device.set_name(VK_OBJECT_TYPE_SHADER_MODULE, out.number(), name);
  return out;
}

Result<PipelineHandle> create_draw_pipeline(const Device& device, const DrawLayout& layout, VkShaderModule vertex,
                                            VkShaderModule fragment, DrawTargets targets, const std::string& name,
                                            std::span<const std::int32_t> constants) {
  std::vector<VkSpecializationMapEntry> entries;
  for (std::uint32_t i = 0; i < constants.size(); ++i)
    entries.push_back({i, i * static_cast<std::uint32_t>(sizeof(std::int32_t)), sizeof(std::int32_t)});
  const VkSpecializationInfo special{.mapEntryCount = static_cast<std::uint32_t>(entries.size()),
                                     .pMapEntries = entries.data(),
                                     .dataSize = constants.size_bytes(),
                                     .pData = constants.data()};
  const auto stage = [](VkShaderStageFlagBits bit, VkShaderModule module, const VkSpecializationInfo* values) {
    return VkPipelineShaderStageCreateInfo{.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                           .pNext = nullptr,
                                           .flags = 0,
                                           .stage = bit,
                                           .module = module,
                                           .pName = "main",
                                           .pSpecializationInfo = values};
  };
  const std::array stages{stage(VK_SHADER_STAGE_VERTEX_BIT, vertex, nullptr),
                          stage(VK_SHADER_STAGE_FRAGMENT_BIT, fragment, constants.empty() ? nullptr : &special)};
  const VkPipelineVertexInputStateCreateInfo no_vertices{.sType =
                                                             VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  const VkPipelineInputAssemblyStateCreateInfo triangles{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
      .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
  const VkPipelineViewportStateCreateInfo viewport{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO, .viewportCount = 1, .scissorCount = 1};
  const VkPipelineRasterizationStateCreateInfo raster{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
      .polygonMode = VK_POLYGON_MODE_FILL,
      .cullMode = VK_CULL_MODE_NONE,
      .lineWidth = 1};
  const VkPipelineMultisampleStateCreateInfo one_sample{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO, .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
  const auto count = static_cast<std::uint32_t>(targets.count);
  const std::vector<VkPipelineColorBlendAttachmentState> overwrite(count, {.colorWriteMask = 0xf});
  const std::vector<VkFormat> formats(count, targets.format);
  const VkPipelineColorBlendStateCreateInfo blend{.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
                                                  .attachmentCount = count,
                                                  .pAttachments = overwrite.data()};
  // Every triangle lies at depth 0, unless its shader says something else.
  const VkPipelineDepthStencilStateCreateInfo depth{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
      .depthTestEnable = VK_TRUE,
      .depthWriteEnable = targets.marks == DrawMarks::writes ? VK_TRUE : VK_FALSE,
      .depthCompareOp = targets.marks == DrawMarks::writes ? VK_COMPARE_OP_ALWAYS : VK_COMPARE_OP_LESS};
  const bool marked = targets.marks != DrawMarks::none;
  constexpr std::array kDynamic{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  const VkPipelineDynamicStateCreateInfo dynamic{.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
                                                 .dynamicStateCount = static_cast<std::uint32_t>(kDynamic.size()),
                                                 .pDynamicStates = kDynamic.data()};
  const VkPipelineRenderingCreateInfo rendering{.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
                                                .colorAttachmentCount = count,
                                                .pColorAttachmentFormats = formats.data(),
                                                .depthAttachmentFormat = marked ? kDepthFormat : VK_FORMAT_UNDEFINED};
  const VkGraphicsPipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                          .pNext = &rendering,
                                          .stageCount = static_cast<std::uint32_t>(stages.size()),
                                          .pStages = stages.data(),
                                          .pVertexInputState = &no_vertices,
                                          .pInputAssemblyState = &triangles,
                                          .pViewportState = &viewport,
                                          .pRasterizationState = &raster,
                                          .pMultisampleState = &one_sample,
                                          .pDepthStencilState = marked ? &depth : nullptr,
                                          .pColorBlendState = &blend,
                                          .pDynamicState = &dynamic,
                                          .layout = layout.pipeline.get(),
                                          .basePipelineIndex = -1};
  VkPipeline pipeline = VK_NULL_HANDLE;
  AFTERGLOW_VK(
      device.vk().vkCreateGraphicsPipelines(device.handle(), device.pipeline_cache(), 1, &info, nullptr, &pipeline),
      "cannot create the pipeline of '" + name + "'");
  PipelineHandle out(device, pipeline);
  device.set_name(VK_OBJECT_TYPE_PIPELINE, out.number(), name);
  return out;
}

Result<void> check_workgroup(const Device& device, Size invocations, std::uint64_t shared_bytes,
                             const std::string& name) {
  const auto& limits = device.properties().limits;
  const auto fail = [&](const std::string& has, const std::string& allows) {
    return Error{ErrorKind::device,
                 fmt::format("the workgroups of '{}' have {}, the device allows {}", name, has, allows)};
  };
  const auto wide = [&](int size, int axis) {
    return static_cast<std::uint32_t>(size) > limits.maxComputeWorkGroupSize[axis];
  };
  if (wide(invocations.width, 0) || wide(invocations.height, 1) ||
      invocations.area() > limits.maxComputeWorkGroupInvocations)
    return fail(fmt::format("{}×{} invocations", invocations.width, invocations.height),
                fmt::format("{}×{}, {} in all", limits.maxComputeWorkGroupSize[0], limits.maxComputeWorkGroupSize[1],
                            limits.maxComputeWorkGroupInvocations));
  if (shared_bytes > limits.maxComputeSharedMemorySize)
    return fail(fmt::format("{} shared bytes", shared_bytes), fmt::format("{}", limits.maxComputeSharedMemorySize));
  return {};
}

Result<PipelineHandle> create_compute_pipeline(const Device& device, const DrawLayout& layout, VkShaderModule module,
                                               const std::string& name) {
  const VkComputePipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                                         .flags = VK_PIPELINE_CREATE_DISPATCH_BASE,
                                         .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                                   .pNext = nullptr,
                                                   .flags = 0,
                                                   .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                                                   .module = module,
                                                   .pName = "main",
                                                   .pSpecializationInfo = nullptr},
                                         .layout = layout.pipeline.get(),
                                         .basePipelineIndex = -1};
  VkPipeline pipeline = VK_NULL_HANDLE;
  AFTERGLOW_VK(
      device.vk().vkCreateComputePipelines(device.handle(), device.pipeline_cache(), 1, &info, nullptr, &pipeline),
      "cannot create the pipeline of '" + name + "'");
  PipelineHandle out(device, pipeline);
  device.set_name(VK_OBJECT_TYPE_PIPELINE, out.number(), name);
  return out;
}

Result<SamplerHandle> create_sampler(const Device& device, VkFilter filter) {
  const VkSamplerCreateInfo info{.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                 .magFilter = filter,
                                 .minFilter = filter,
                                 .mipmapMode = VK_SAMPLER_MIPMAP_MODE_NEAREST,
                                 .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                 .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                 .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE};
  VkSampler sampler = VK_NULL_HANDLE;
  AFTERGLOW_VK(device.vk().vkCreateSampler(device.handle(), &info, nullptr, &sampler), "cannot create a sampler");
  return SamplerHandle(device, sampler);
}

}  // namespace afterglow
