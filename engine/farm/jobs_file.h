// SPDX-License-Identifier: MIT
// A job for schedulers that Afterglow does not speak to: its chunks with their commands, needs and outputs, as JSON.
#pragma once

#include <string>
#include <vector>

#include "core/result.h"
#include "farm/job.h"

namespace afterglow::farm {

/// `frames` are those of the job, in the order of the chunks. Errors: usage (a name that is no UTF-8).
Result<std::string> jobs_text(const Job& job, const FrameListRequest& request, const std::vector<FrameJob>& frames);

}  // namespace afterglow::farm
