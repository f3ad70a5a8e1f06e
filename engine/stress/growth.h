// SPDX-License-Identifier: MIT
// How errors grow from level to level of a pyramid, by what is in the picture.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "image/metrics.h"
#include "stress/trial.h"

namespace afterglow::stress {

/// The error against double precision of one effect, with so many levels.
struct GrowthRow {
  std::string effect, variant;  ///< "defaults", or the choice that differs: "mode = \"scattering\""
  std::string picture;          ///< kind
  int levels = 0;
  ErrorMeasure fp32, fp16;  ///< fp16: empty where the picture is not exact in half floats
  bool has_fp16 = false;
};

/// Of every subject whose promise about its error names the setting that counts levels (`levels`), until more levels
/// change nothing. `quick`: the defaults and three kinds of picture alone. Errors: as Harness::run; what `step`
/// returns.
Result<std::vector<GrowthRow>> error_growth(Harness& harness, const std::vector<Subject>& subjects, Size size,
                                            bool quick, std::uint64_t seed, const std::function<Result<void>()>& step);

/// Columns of text: the worst over all kinds of pictures for each effect and number of levels.
std::string growth_text(const std::vector<GrowthRow>& rows);

}  // namespace afterglow::stress
