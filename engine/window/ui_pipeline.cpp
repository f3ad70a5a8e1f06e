// SPDX-License-Identifier: MIT
#include "window/ui_pipeline.h"

#include <imgui.h>

#include <cstddef>

#include "gpu/error.h"
#include "gpu/pipeline.h"
#include "gpu/swapchain.h"
#include "ui.frag.h"
#include "ui.vert.h"

namespace afterglow {

namespace {

Result<void> make_layouts(const Device& device, UiPipeline& out) {
  const VkDescriptorSetLayoutBinding atlas{.binding = 0,
                                           .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                           .descriptorCount = 1,
                                           .stageFlags = VK_SHADER_STAGE_FRAGMENT_BIT};
  const VkDescriptorSetLayoutCreateInfo set_info{
      .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, .bindingCount = 1, .pBindings = &atlas};
  VkDescriptorSetLayout set = VK_NULL_HANDLE;
  AFTERGLOW_VK(device.vk().vkCreateDescriptorSetLayout(device.handle(), &set_info, nullptr, &set),
               "cannot create a descriptor layout");
  out.set = SetLayoutHandle(device, set);
  const VkPushConstantRange push{VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(UiPush)};
  const VkPipelineLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                        .setLayoutCount = 1,
                                        .pSetLayouts = &set,
                                        .pushConstantRangeCount = 1,
                                        .pPushConstantRanges = &push};
  VkPipelineLayout layout = VK_NULL_HANDLE;
  AFTERGLOW_VK(device.vk().vkCreatePipelineLayout(device.handle(), &info, nullptr, &layout),
               "cannot create a pipeline layout");
  out.layout = PipelineLayoutHandle(device, layout);
  return {};
}

constexpr VkPipelineColorBlendAttachmentState kOver{
    .blendEnable = VK_TRUE,
    .srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA,
    .dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA,
    .colorBlendOp = VK_BLEND_OP_ADD,
    .srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE,
    .dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA,
    .alphaBlendOp = VK_BLEND_OP_ADD,
    .colorWriteMask =
        VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT};

constexpr VkVertexInputBindingDescription kVertex{0, sizeof(ImDrawVert), VK_VERTEX_INPUT_RATE_VERTEX};
constexpr std::array<VkVertexInputAttributeDescription, 3> kAttributes{{
    {0, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(ImDrawVert, pos)},
    {1, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(ImDrawVert, uv)},
    {2, 0, VK_FORMAT_R8G8B8A8_UNORM, offsetof(ImDrawVert, col)},
}};

Result<PipelineHandle> make_pipeline(const Device& device, VkPipelineLayout layout, VkFormat target) {
  AFTERGLOW_TRY(const auto vertex, create_shader_module(device, kUiVert, "interface"));
  AFTERGLOW_TRY(const auto fragment, create_shader_module(device, kUiFrag, "interface"));
  const VkBool32 linear = encodes_srgb(target) ? VK_TRUE : VK_FALSE;
  const VkSpecializationMapEntry entry{0, 0, sizeof linear};
  const VkSpecializationInfo special{1, &entry, sizeof linear, &linear};
  const std::array<VkPipelineShaderStageCreateInfo, 2> stages{{
      {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
       .stage = VK_SHADER_STAGE_VERTEX_BIT,
       .module = vertex.get(),
       .pName = "main",
       .pSpecializationInfo = &special},
      {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
       .stage = VK_SHADER_STAGE_FRAGMENT_BIT,
       .module = fragment.get(),
       .pName = "main",
       .pSpecializationInfo = &special},
  }};
  const VkPipelineVertexInputStateCreateInfo input{.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
                                                   .vertexBindingDescriptionCount = 1,
                                                   .pVertexBindingDescriptions = &kVertex,
                                                   .vertexAttributeDescriptionCount = kAttributes.size(),
                                                   .pVertexAttributeDescriptions = kAttributes.data()};
  const VkPipelineInputAssemblyStateCreateInfo assembly{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
      .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
  const VkPipelineViewportStateCreateInfo viewport{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO, .viewportCount = 1, .scissorCount = 1};
  const VkPipelineRasterizationStateCreateInfo raster{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO, .lineWidth = 1};
  const VkPipelineMultisampleStateCreateInfo samples{.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
                                                     .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
  const VkPipelineColorBlendStateCreateInfo blend{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO, .attachmentCount = 1, .pAttachments = &kOver};
  const std::array dynamic{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  const VkPipelineDynamicStateCreateInfo states{.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
                                                .dynamicStateCount = dynamic.size(),
                                                .pDynamicStates = dynamic.data()};
  const VkPipelineRenderingCreateInfo rendering{.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
                                                .colorAttachmentCount = 1,
                                                .pColorAttachmentFormats = &target};
  const VkGraphicsPipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                          .pNext = &rendering,
                                          .stageCount = stages.size(),
                                          .pStages = stages.data(),
                                          .pVertexInputState = &input,
                                          .pInputAssemblyState = &assembly,
                                          .pViewportState = &viewport,
                                          .pRasterizationState = &raster,
                                          .pMultisampleState = &samples,
                                          .pColorBlendState = &blend,
                                          .pDynamicState = &states,
                                          .layout = layout};
  VkPipeline made = VK_NULL_HANDLE;
  AFTERGLOW_VK(
      device.vk().vkCreateGraphicsPipelines(device.handle(), device.pipeline_cache(), 1, &info, nullptr, &made),
      "cannot create the pipeline of the interface");
  PipelineHandle out(device, made);
  device.set_name(VK_OBJECT_TYPE_PIPELINE, out.number(), "interface");
  return out;
}

}  // namespace

Result<UiPipeline> UiPipeline::create(const Device& device, VkFormat target) {
  UiPipeline out;
  AFTERGLOW_CHECK(make_layouts(device, out));
  AFTERGLOW_TRY(out.pipeline, make_pipeline(device, out.layout.get(), target));
  AFTERGLOW_TRY(out.sampler, create_sampler(device, VK_FILTER_LINEAR));
  return out;
}

}  // namespace afterglow
