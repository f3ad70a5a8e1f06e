// SPDX-License-Identifier: MIT
// `afterglow graph --traffic`: the bytes that a preset's kernels move, in each way of execution.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "graph/region.h"

namespace afterglow {

struct TrafficOptions {
  std::optional<double> bandwidth;  ///< GB/s (1e9 bytes) of a device, to tell times by
  std::optional<Rect> part;         ///< of the result; empty: all of it
};

/// A table of the ways, and one of the kernels of the way that GPUs take for the smallest error.
std::string traffic_text(const Graph& graph, const std::string& title, const TrafficOptions& options);
nlohmann::ordered_json traffic_json(const Graph& graph, const TrafficOptions& options);

}  // namespace afterglow
