// SPDX-License-Identifier: MIT
// From the passes of a plan's kernel to the description that the shader room compiles, and back from what the compiler
// found to passes and images of the graph.
#pragma once

#include <cstdint>
#include <vector>

#include "exec/program.h"
#include "graph/graph.h"
#include "graph/plan.h"
#include "shader/kernel.h"

namespace afterglow {

/// `options.config` is taken as it is, whatever the device. Errors: script (an unknown shader).
Result<KernelDesc> describe_kernel(ShaderLibrary& shaders, const Graph& graph, const PlanKernel& kernel,
                                   const ProgramOptions& options);

/// Whether passes that do not compile as one kernel may do so apart: shaders have limits of what they hold
/// (docs/writing_effects.md), which each of them may keep and all together not.
bool may_compile_apart(const Error& error, const ExecutionConfig& config);

/// The pass that a stage of the kernel (AssembledKernel::ImageSlot::stage, KernelParam::stage) is.
const Pass& pass_of_stage(const Graph& graph, const PlanKernel& kernel, int stage);

/// The input of that name, or null.
const PassInput* input_of(const Pass& pass, const std::string& name);

/// The images to bind, in the order of the compiled kernel's slots. Errors: script (a pass that lacks an input its
/// shader declares).
Result<std::vector<ImageId>> images_of_slots(const Graph& graph, const PlanKernel& kernel,
                                             const CompiledKernel& compiled);

/// Kernels of the same text share one compilation.
struct CompiledKernels {
  std::vector<CompiledKernel> unique;
  std::vector<int> index;  ///< parallel to the kernels given
};
/// Compiles over threads. Errors: those of the compiler, of the first kernel that fails.
Result<CompiledKernels> compile_kernels(KernelCompiler& compiler, const std::vector<KernelDesc>& kernels);

}  // namespace afterglow
