// SPDX-License-Identifier: MIT
// From a look and frames to a job of chunks.
#pragma once

#include <memory>

#include "apps/console.h"
#include "apps/farm_arguments.h"
#include "core/file_lock.h"

namespace afterglow {

/// A job that is planned, and what it was planned from.
struct PlannedJob {
  farm::Job job;
  FrameListRequest files;
  std::vector<FrameJob> frames;
  std::filesystem::path new_folder{};  ///< of the outputs, that was made for the job; empty: it was there
  std::unique_ptr<FileLock> alone{};   ///< of a job that is written: none other is submitted beside its outputs
};

/// Lists the frames, loads the look, cuts the chunks. With `write` its folder is made and everything is packed into
/// it; without, nothing is written and the folder is the one that it could have. Errors: usage, script, io.
Result<PlannedJob> plan_job(const FarmArguments& arguments, bool write, Console& console);

/// Removes what `plan_job` has written.
void discard(const PlannedJob& planned);

}  // namespace afterglow
