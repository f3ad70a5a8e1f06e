#include "exec/kernel_pipelines.h"

#include <optional>

#include "exec/parallel.h"
#include "gpu/fullscreen_vertex.h"

namespace afterglow {

std::vector<VkDescriptorType> descriptor_types(const CompiledKernel& kernel) {
  std::vector<VkDescriptorType> types;
  for (const auto& image : kernel.images)
    types.push_back(image.read == ImageRead::sampled ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER
                                                     : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
  return types;
}

namespace {

VkFormat format_of(KernelTarget target) {
  switch (target) {
    case KernelTarget::float16:
      return VK_FORMAT_R16G16B16A16_SFLOAT;
    case KernelTarget::codes8:
      return VK_FORMAT_R8G8B8A8_UNORM;
    default:
      return VK_FORMAT_R32G32B32A32_SFLOAT;
  }
}

DrawInterface interface_of(const CompiledKernel& kernel) {
  return {.block = kernel.block_size > 0, .images = descriptor_types(kernel), .push_bytes = kPushConstantBytes};
}

}  // namespace

Result<KernelPipelines> KernelPipelines::create(const Device& device, const std::vector<CompiledKernel>& kernels,
                                                const std::vector<std::string>& names, VkFormat format) {
  KernelPipelines out;
  for (const auto& kernel : kernels) {
    const DrawInterface interface = interface_of(kernel);
    if (out.layouts_.contains(interface)) continue;
    AFTERGLOW_TRY(DrawLayout layout, create_draw_layout(device, interface));
    out.layouts_.emplace(interface, std::move(layout));
  }
  AFTERGLOW_TRY(const ShaderModuleHandle vertex,
                create_shader_module(device, kFullscreenVertex, "full-screen triangle"));
  std::vector<std::optional<Result<PipelineHandle>>> made(kernels.size());
  parallel_for(made.size(), [&](std::size_t i) {
    auto fragment = create_shader_module(device, kernels[i].spirv, names[i]);
    if (!fragment) {
      made[i].emplace(std::move(fragment).error());
      return;
    }
    made[i].emplace(create_draw_pipeline(
        device, out.layout(kernels[i]), vertex.get(), fragment->get(),
        {format != VK_FORMAT_UNDEFINED ? format : format_of(kernels[i].target), kernels[i].rows}, names[i]));
  });
  for (auto& pipeline : made) {
    if (!*pipeline) return std::move(*pipeline).error();
    out.pipelines_.push_back(std::move(*pipeline).value());
  }
  return out;
}

const DrawLayout& KernelPipelines::layout(const CompiledKernel& kernel) const {
  return layouts_.at(interface_of(kernel));
}

}  // namespace afterglow
