// SPDX-License-Identifier: MIT
// Skipping by content: which effects have nothing to do for a frame, known from its source alone, and the graph without
// them. Pure data.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "graph/graph.h"

namespace afterglow {

/// What is known of the pixels of a frame's source.
struct SourceContent {
  float brightest = std::numeric_limits<float>::quiet_NaN();  ///< the largest red, green or blue; NaN: no light
  bool opaque = false;                                        ///< alpha is 1 everywhere
};

/// Parallel to `graph.idle`: true where the condition holds for a source whose largest red, green or blue is
/// `brightest` (NaN when some are negative or not finite: then none holds). An effect that looks at the output of idle
/// ones looks at the source too; of what other passes make nothing is known.
std::vector<bool> idle_effects(const Graph& graph, float brightest);

/// Passes that want straight colour (Pass::straight).
int straight_passes(const Graph& graph);

/// The graph for sources whose alpha is 1 everywhere: no pass divides by it. What was left out is among `skipped`.
Graph without_division(Graph graph);

/// "division by alpha in 3 passes: alpha is 1 everywhere"
Skipped skipped_division(int passes);

/// The graph in which every image that an idle effect makes is replaced by the one it is equal to, without the passes
/// that nobody reads any more. Each idle effect is among `skipped`, with its reason. Inputs stay as they are, read or
/// not, so that both graphs take the same frames.
Graph without_idle(const Graph& graph, const std::vector<bool>& idle);

/// "nothing is brighter than 0.5"
std::string idle_reason(const IdleCondition& condition);

}  // namespace afterglow
