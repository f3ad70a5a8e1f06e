// SPDX-License-Identifier: MIT
// Waiting for a farm job.
#pragma once

#include "apps/console.h"
#include "core/result.h"
#include "farm/job.h"

namespace afterglow {

/// Shows one line of progress over all nodes until nothing more is to come. Errors: interrupted (the job goes on), io,
/// and what status.h calls the outcome.
Result<void> wait_for_job(const farm::Job& job, Console& console);

}  // namespace afterglow
