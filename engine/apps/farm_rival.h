// SPDX-License-Identifier: MIT
// Jobs that make the same outputs at the same time.
#pragma once

#include <filesystem>

#include "apps/farm_submit.h"

namespace afterglow {

/// Looks at the jobs beside `outputs` that Slurm has and that have not ended. Errors (io, naming the job): one of them
/// makes an output that the planned job would make.
Result<void> check_no_rival(const PlannedJob& planned, const std::filesystem::path& outputs);

}  // namespace afterglow
