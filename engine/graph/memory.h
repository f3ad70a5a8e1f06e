// SPDX-License-Identifier: MIT
// How much device memory the images of a graph take, before anything is made.
#pragma once

#include <cstdint>

#include "graph/graph.h"
#include "shader/execution_config.h"

namespace afterglow {

/// Bytes, with the inputs and the result. Of `config` it reads `fusion`, `storage` and `share_memory`.
std::uint64_t memory_needed(const Graph& graph, const ExecutionConfig& config);

}  // namespace afterglow
