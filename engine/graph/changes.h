// SPDX-License-Identifier: MIT
// What has to run again when something has changed. Pure functions.
#pragma once

#include <functional>
#include <vector>

#include "core/hash.h"
#include "graph/plan.h"

namespace afterglow {

/// What each kernel's image holds after it has run, as a key: equal keys mean equal pixels. Parallel to the plan's
/// kernels. `own`: of what each kernel does (its code and its parameters); `brought`: of the pixels of an image that no
/// kernel makes (an input, what a history holds).
std::vector<Hash> content_keys(const Graph& graph, const Plan& plan, const std::vector<Hash>& own,
                               const std::function<Hash(ImageId)>& brought);

/// Parallel to the plan's kernels: those whose image is `stale` (does not hold what it should) and wanted: by the
/// result, by a history, or by a kernel that runs.
std::vector<bool> kernels_to_run(const Graph& graph, const Plan& plan, const std::vector<bool>& stale);

}  // namespace afterglow
