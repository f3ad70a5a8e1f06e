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

struct DescribeOptions {
  bool hardware_filter = false;
  bool half_storage = false;
  bool codes = false;              ///< the result holds 8-bit codes
  bool flag_non_finite = false;    ///< see ProgramOptions
  bool storage_reads = false;      ///< images between kernels are read as storage images where their shaders allow it
  bool source_is_storage = false;  ///< the source too
  int rows = 1;                    ///< an invocation may make so many where that pays
  WorthAKernel worth;
  bool hide_uniforms = false;  ///< see KernelDesc
};

/// Errors: script (an unknown shader).
Result<KernelDesc> describe_kernel(ShaderLibrary& shaders, const Graph& graph, const PlanKernel& kernel,
                                   const DescribeOptions& options);

/// The pass that a stage of the kernel (AssembledKernel::ImageSlot::stage, KernelParam::stage) is.
const Pass& pass_of_stage(const Graph& graph, const PlanKernel& kernel, int stage);

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
