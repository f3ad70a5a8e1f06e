// SPDX-License-Identifier: MIT
// One chunk of a farm job, made on this machine; and the video that is joined of all.
#pragma once

#include <string>

#include "apps/console.h"
#include "core/result.h"
#include "farm/job.h"

namespace afterglow {

/// Makes what is missing of the chunk and leaves a report in the job's folder. Errors: those of `run`, and io where
/// the job's files are not what they were.
Result<void> run_chunk(const std::string& job_folder, const std::string& number, Console& console);

/// Makes the video of a job from what its chunks have left, which then goes. Errors: io (a chunk is not done), usage (a
/// job of pictures), interrupted.
Result<void> run_join(const farm::Job& job, Console& console);

}  // namespace afterglow
