// SPDX-License-Identifier: MIT
// One chunk of a farm job, made on this machine.
#pragma once

#include <string>

#include "apps/console.h"
#include "core/result.h"

namespace afterglow {

/// Makes what is missing of the chunk and leaves a report in the job's folder. Errors: those of `run`, and io where
/// the job's files are not what they were.
Result<void> run_chunk(const std::string& job_folder, const std::string& number, Console& console);

}  // namespace afterglow
