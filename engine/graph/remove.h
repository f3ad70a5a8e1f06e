// SPDX-License-Identifier: MIT
// Takes passes out of a graph. Pure.
#pragma once

#include <vector>

#include "graph/graph.h"

namespace afterglow {

/// Without these passes (parallel to the graph's) and the images that they make, and without `images` (parallel to the
/// graph's, or empty); the rest is numbered anew. Nothing that stays may read what goes.
void remove_passes(Graph& graph, const std::vector<bool>& passes, const std::vector<bool>& images = {});

}  // namespace afterglow
