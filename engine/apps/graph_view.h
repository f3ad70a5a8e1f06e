// SPDX-License-Identifier: MIT
// A graph and its plan as pictures and data.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "graph/graph.h"
#include "graph/plan.h"

namespace afterglow {

/// Why the passes of a kernel behind its first were fused to it.
inline constexpr const char* kFusionReason = "read only their own pixel of an image that nobody else reads";

/// What there is to say about entries: by name, "opacity 0.5, mask luma".
using Notes = std::vector<std::pair<std::string, std::string>>;

std::string graph_dot(const Graph& graph, const Plan& plan, const std::string& title, const Notes& notes);
std::string graph_svg(const Graph& graph, const Plan& plan, const std::string& title, const Notes& notes);
std::string graph_json(const Graph& graph, const Plan& plan, const std::string& title, const Notes& notes);

/// What was skipped, by the script and by the plan.
std::vector<Skipped> all_skipped(const Graph& graph, const Plan& plan);
/// What frames may leave out because of their content: "glow, when nothing is brighter than 0.5".
std::vector<std::string> idle_lines(const Graph& graph);
/// Index of the kernel that runs a pass, or -1 when it was dropped.
int kernel_of(const Plan& plan, int pass);
/// "1920×1080" of the image a pass makes.
std::string size_text(const Graph& graph, const Pass& pass);

}  // namespace afterglow
