// SPDX-License-Identifier: MIT
// Images read as storage images, for drivers that run shaders on the CPU: there a texel takes a third of the time that
// a sampler takes.
#pragma once

#include <vector>

#include "exec/program.h"

namespace afterglow {

/// One wish for each image slot of `desc`, in the order that AssembledKernel::images has. What is not between kernels
/// is sampled, and so are inputs, unless `options.inputs_are_storage`, and what is over `options.most_storage_reads`.
std::vector<ImageRead> storage_reads_of(const Graph& graph, const PlanKernel& kernel, const KernelDesc& desc,
                                        const ProgramOptions& options);

}  // namespace afterglow
