// SPDX-License-Identifier: MIT
// `bench --temporal`: shots and resolutions of every look and setting.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/stability.h"

namespace afterglow::bench {

struct StabilityRequest {
  std::vector<std::filesystem::path> presets;
  SessionOptions options;
  std::vector<Variant> variants;
  std::vector<Size> sizes;  ///< resolutions to compare, with the first
  std::string shot;         ///< a pattern of files; empty: drifting highlights
  bool quick = false;       ///< few small frames, to see that it works
};

/// How often `step` is called.
std::size_t steps_of(const StabilityRequest& request);
/// Fills in `temporal` and `resolutions` of the report. Errors: script, usage, device, io, those of `step`.
Result<void> measure_stability(const StabilityRequest& request, Report& report, Diagnostics& diagnostics,
                               const Step& step);

}  // namespace afterglow::bench
