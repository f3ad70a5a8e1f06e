// SPDX-License-Identifier: MIT
// What `bench` is asked to measure: sizes, ways of execution, varied settings.
#pragma once

#include <string>
#include <vector>

#include "bench/prepared_stack.h"
#include "core/geometry.h"
#include "core/result.h"

namespace afterglow {

/// "1920x1080,3840x2160". Errors: usage.
Result<std::vector<Size>> parse_sizes(const std::string& text);

/// "plain16f,fused fp32+storage-reads,chosen": choices, "chosen" for what `run` would do, "checked" for that with
/// values that are not finite looked for, as `run` does. Errors: usage.
Result<std::vector<bench::Variant>> parse_variants(const std::string& text);

/// Each variant with each combination of the values of `vary` ("glow.scatter=0.5,0.7", one text a setting). Errors:
/// usage.
Result<std::vector<bench::Variant>> vary_settings(const std::vector<bench::Variant>& variants,
                                                  const std::vector<std::string>& vary);

/// Squares of 256, 512, … up to `most`.
std::vector<Size> scaling_sizes(int most);

/// The variants that are measured when none are named: the baseline in half and full floats, each optimisation alone
/// and all together, and what `run` would choose.
inline constexpr const char* kDefaultVariants =
    "plain16f,plain32f,fused-filters fp32,fused-filters fp32 storage-reads,fused fp32,fused fp16 storage-reads,"
    "fused fp32 storage-reads,fused-filters fp32 rows8,fused fp32 storage-reads rows8,chosen";

}  // namespace afterglow
