// SPDX-License-Identifier: MIT
// A look packed for other machines: what is edited later changes nothing.
//
// Every file that the preset was seen to read lies in the pack, below `look/files`, under its whole path, so that all
// that is found from the preset's folder, a --path or AFTERGLOW_PATH is found there in the same way. The installation
// is not packed: the lock tells when it is another.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "batch/batch_run.h"
#include "core/diagnostics.h"
#include "core/result.h"
#include "farm/job.h"

namespace afterglow::farm {

/// What was found when a look was loaded.
struct LoadedLook {
  std::optional<int> pre_roll;                     ///< empty: no frame depends on another
  std::vector<std::filesystem::path> files;        ///< absolute, of those that are to be packed
  std::vector<std::filesystem::path> folders;      ///< that were there, absolute
  std::map<std::string, std::string> environment;  ///< that it depends on; empty: not set
};

/// Loads the look and asks it about frames; needs no device. Errors: script, usage.
Result<LoadedLook> load_look(const BatchRequest& request, const std::vector<FrameJob>& frames,
                             Diagnostics& diagnostics);

/// Where a file or folder of this machine lies in the pack of the job in `folder`.
std::filesystem::path packed_place(const std::filesystem::path& folder, const std::filesystem::path& file);

/// Copies what the look reads into the job's folder, and notes the hashes. Errors: io.
Result<void> pack_look(const LoadedLook& look, Job& job);
/// Copies one file to `name` in the job's folder. Errors: io.
Result<void> pack_file(const std::filesystem::path& file, const std::string& name, Job& job);

/// Loads the packed look as chunks will (`request`) and writes down what it is made of in all frames, as
/// look/lock.json. It must be the look of `locked`, unless that is empty. Errors: script, io.
Result<void> lock_packed_look(const BatchRequest& request, const std::vector<FrameJob>& frames,
                              const std::filesystem::path& locked, Job& job, Diagnostics& diagnostics);

}  // namespace afterglow::farm
