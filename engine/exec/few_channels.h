// SPDX-License-Identifier: MIT
// Whether images of one and two channels can stand for those of four.
#pragma once

#include "gpu/device.h"
#include "graph/graph.h"

namespace afterglow {

/// Whether the device can do with the graph's images of one and two channels what those of four are used for; true
/// where there are none. Linear ones are another matter (can_be_linear). Where a history has such images, the answer is
/// the same for all graphs with histories and for all ways of execution: they share its images.
bool holds_few_channels(const Device& device, const Graph& graph, const ExecutionConfig& config);

}  // namespace afterglow
