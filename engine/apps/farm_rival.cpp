// SPDX-License-Identifier: MIT
#include "apps/farm_rival.h"

#include <fmt/format.h>

#include <set>

#include "apps/farm_arguments.h"
#include "core/inside.h"
#include "farm/status.h"

namespace afterglow {
namespace {

namespace fs = std::filesystem;

std::set<fs::path> outputs_of(const farm::Job& job, const std::vector<FrameJob>& frames) {
  if (!job.video.empty()) return {job.video};
  std::set<fs::path> out;
  for (const FrameJob& frame : frames) out.insert(whole_path(job.at / frame.output));
  return out;
}

/// As its chunks list them. Errors: its inputs are gone.
Result<std::set<fs::path>> outputs_of(const farm::Job& job) {
  AFTERGLOW_TRY(BatchRequest request, request_of_words(job.run));
  request.files.output = (job.at / request.files.output).string();
  std::vector<FrameJob> frames;
  Diagnostics silent;
  for (const farm::Chunk& inputs : job.inputs()) {
    request.files.inputs.clear();
    for (const auto& input : inputs.inputs) request.files.inputs.push_back((job.at / input).string());
    request.files.frames = inputs.frames;
    AFTERGLOW_TRY(FrameList list, list_frames(request.files, silent));
    std::ranges::move(list.jobs, std::back_inserter(frames));
  }
  return outputs_of(job, frames);
}

}  // namespace

Result<void> check_no_rival(const PlannedJob& planned, const fs::path& outputs) {
  std::set<fs::path> mine;
  for (const fs::path& folder : farm::job_folders(outputs.empty() ? "." : outputs)) {
    const auto job = farm::read_job(folder);
    if (!job) continue;
    const auto status = farm::status_of(*job);
    if (!status || status->arrays.empty() || !status->live()) continue;
    const auto others = outputs_of(*job);
    if (!others) continue;
    if (mine.empty()) mine = outputs_of(planned.job, planned.frames);
    for (const fs::path& output : mine)
      if (others->contains(output))
        return Error{
            ErrorKind::io,
            fmt::format("this job is not done ({}) and makes {} too", farm::status_line(*status), output.string()),
            job->folder.string(), 0,
            fmt::format("`afterglow farm status --wait {0}` or `afterglow farm cancel {0}` first",
                        job->folder.string())};
  }
  return {};
}

}  // namespace afterglow
