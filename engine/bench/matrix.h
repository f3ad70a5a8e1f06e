// SPDX-License-Identifier: MIT
// Looks × sizes × ways of execution: what `bench` measures, and the words in which it is asked for.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/cell.h"
#include "core/geometry.h"
#include "core/result.h"

namespace afterglow::bench {

/// What `run` would do; the same with values that are not finite looked for, as `run` does.
inline constexpr const char *kChosen = "chosen", *kChecked = "checked";

/// "plain16f,fused fp32 storage-reads,chosen": ways of execution, kChosen and kChecked. Errors: usage.
Result<std::vector<Variant>> parse_variants(const std::string& text);

/// Each variant with each combination of the values of `vary` ("glow.scatter=0.5,0.7", one text a setting). Errors:
/// usage.
Result<std::vector<Variant>> vary_settings(const std::vector<Variant>& variants, const std::vector<std::string>& vary);

/// The variants that are measured when none are named: the baseline in half and full floats, each optimisation alone
/// and all together, and what `run` would choose.
inline constexpr const char* kDefaultVariants =
    "plain16f,plain32f,fused-filters fp32,fused-filters fp32 storage-reads,fused fp32,fused fp16 storage-reads,"
    "fused fp32 storage-reads,fused-filters fp32 rows8,fused fp32 storage-reads rows8,chosen";

struct MatrixRequest {
  std::vector<std::filesystem::path> presets;
  StackOptions base;
  std::vector<Size> sizes;
  std::vector<Variant> variants;
  int scaling = 0;                ///< also squares of 256, 512, … up to this side, as `run` executes them
  std::filesystem::path picture;  ///< scaled to each size; empty: a made scene
  int repeat = 9;

  std::size_t cells() const;  ///< that will be measured
};

/// Adds a cell for each look and size to the report. Errors: script, usage, io, device, those of `step`.
Result<void> measure_matrix(Device& device, const MatrixRequest& request, Report& report, Diagnostics& diagnostics,
                            const Step& step);

}  // namespace afterglow::bench
