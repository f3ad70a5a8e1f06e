// SPDX-License-Identifier: MIT
#include "exec/kernel_pipelines.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <span>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "gpu/fullscreen_vertex.h"
#include "gpu/image.h"

namespace afterglow {

std::vector<VkDescriptorType> descriptor_types(const CompiledKernel& kernel) {
  std::vector<VkDescriptorType> types;
  for (const auto& image : kernel.images)
    types.push_back(image.read == ImageRead::sampled ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER
                                                     : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
  if (kernel.workgroup) types.push_back(VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);  // the target
  if (!kernel.loops.empty()) types.push_back(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
  return types;
}

namespace {

DrawInterface interface_of(const CompiledKernel& kernel) {
  return {.block = kernel.block_size > 0,
          .images = descriptor_types(kernel),
          .push_bytes = kPushConstantBytes,
          .compute = kernel.workgroup.has_value(),
          .vertex = !kernel.workgroup};
}

VkFormat format_of(const CompiledKernel& kernel, VkFormat given) {
  if (given != VK_FORMAT_UNDEFINED) return given;
  if (kernel.target == KernelTarget::unorm8) return VK_FORMAT_R8G8B8A8_UNORM;
  return float_format(kernel.target_channels, kernel.target == KernelTarget::float16);
}

/// Outputs of four numbers that a vertex shader may hand on beside the place.
std::uint32_t locations_of(const Device& device) {
  const auto& limits = device.properties().limits;
  return std::min(limits.maxVertexOutputComponents, limits.maxFragmentInputComponents) / 4 - 1;
}

struct Made {
  PipelineHandle pipeline, rest;
};

Result<Made> make(const Device& device, const CompiledKernel& kernel, const DrawLayout& layout, VkShaderModule vertex,
                  VkFormat format, const std::string& name) {
  Made made;
  if (const auto& group = kernel.workgroup)
    AFTERGLOW_CHECK(check_workgroup(device, group->invocations, kernel.shared_bytes, name));
  const std::vector<std::uint32_t>* spirv = &kernel.spirv;
  std::optional<FlatParameters> flat;
  ShaderModuleHandle own_vertex;
  if (kernel.flat_parameters) flat = flat_parameters(kernel.spirv, locations_of(device));
  if (flat) {
    AFTERGLOW_TRY(own_vertex, create_shader_module(device, flat->vertex, name));
    vertex = own_vertex.get();
    spirv = &flat->fragment;
  }
  AFTERGLOW_TRY(const ShaderModuleHandle module, create_shader_module(device, *spirv, name));
  if (kernel.workgroup) {
    AFTERGLOW_TRY(made.pipeline, create_compute_pipeline(device, layout, module.get(), name));
    return made;
  }
  const auto draw = [&](const ShaderModuleHandle& shader, KernelDraw which, DrawMarks marks) {
    const std::int32_t constant = static_cast<std::int32_t>(which);
    return create_draw_pipeline(device, layout, vertex, shader.get(), {format, kernel.rows, marks}, name,
                                which == KernelDraw::all ? std::span<const std::int32_t>() : std::span(&constant, 1));
  };
  if (!kernel.two_draws) {
    AFTERGLOW_TRY(made.pipeline, draw(module, KernelDraw::all, DrawMarks::none));
    return made;
  }
  AFTERGLOW_TRY(made.pipeline, draw(module, KernelDraw::done, DrawMarks::writes));
  AFTERGLOW_TRY(const ShaderModuleHandle early, create_shader_module(device, tested_early(*spirv), name));
  AFTERGLOW_TRY(made.rest, draw(early, KernelDraw::rest, DrawMarks::tests));
  return made;
}

}  // namespace

Result<KernelPipelines> KernelPipelines::create(const Device& device, const std::vector<CompiledKernel>& kernels,
                                                const std::vector<std::string>& names, VkFormat format,
                                                PipelinePool* pool) {
  PipelinePool own;
  if (!pool) pool = &own;
  const auto start = Clock::now();
  KernelPipelines out;
  out.pipelines_.resize(kernels.size());
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < kernels.size(); ++i) {
    const DrawInterface interface = interface_of(kernels[i]);
    if (!out.layouts_.contains(interface)) {
      AFTERGLOW_TRY(out.layouts_[interface], pool->layout(device, interface));
    }
    out.pipelines_[i] = pool->find(kernels[i], format_of(kernels[i], format));
    if (!out.pipelines_[i]) missing.push_back(i);
  }
  if (missing.empty()) return out;
  AFTERGLOW_TRY(const ShaderModuleHandle vertex,
                create_shader_module(device, kFullscreenVertex, "full-screen triangle"));
  // The longest first: that of a look's last kernel often takes ten times as long as another, and would begin when
  // nothing is left to do beside it.
  std::ranges::stable_sort(missing, std::greater(), [&](std::size_t i) { return kernels[i].spirv.size(); });
  std::vector<std::optional<Result<Made>>> made(missing.size());
  parallel_tasks(made.size(), [&](std::size_t k) {
    const std::size_t i = missing[k];
    made[k].emplace(
        make(device, kernels[i], out.layout(kernels[i]), vertex.get(), format_of(kernels[i], format), names[i]));
  });
  for (std::size_t k = 0; k < missing.size(); ++k) {
    if (!*made[k]) return std::move(*made[k]).error();
    const CompiledKernel& kernel = kernels[missing[k]];
    out.pipelines_[missing[k]] = pool->add(kernel, format_of(kernel, format),
                                           {out.layouts_.at(interface_of(kernel)), std::move(made[k]->value().pipeline),
                                            std::move(made[k]->value().rest)});
  }
  pool->add_time(milliseconds_since(start));
  return out;
}

const DrawLayout& KernelPipelines::layout(const CompiledKernel& kernel) const {
  return *layouts_.at(interface_of(kernel));
}

}  // namespace afterglow
