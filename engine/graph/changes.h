// What has to run again when something has changed. Pure functions.
#pragma once

#include <vector>

#include "graph/plan.h"

namespace afterglow {

/// Parallel to the plan's kernels: those of `changed_kernels` (their parameters have new values), those that read an
/// image of `changed_images` (inputs with new pixels), and all that read what these make.
std::vector<bool> kernels_to_run(const Graph& graph, const Plan& plan, const std::vector<bool>& changed_kernels,
                                 const std::vector<ImageId>& changed_images);

}  // namespace afterglow
