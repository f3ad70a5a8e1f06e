// SPDX-License-Identifier: MIT
// The reports of all chunks as one.
#pragma once

#include <string>

#include "core/result.h"
#include "farm/job.h"
#include "farm/status.h"

namespace afterglow::farm {

/// Of every frame what its last try says, with the times of the try that made it; sums by node and device.
struct MergedReport {
  std::string text;  ///< for people
  std::string json;
};
/// Errors: io. A report that cannot be read is left out and said so.
Result<MergedReport> merged_report(const Job& job, const JobStatus& status);

}  // namespace afterglow::farm
