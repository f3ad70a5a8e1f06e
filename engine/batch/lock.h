// SPDX-License-Identifier: MIT
// --lock and --locked: what a run was made with, written down, and held against what is there now.
//
// A lock is a small JSON file. Its `look` is all that decides the pixels besides the pictures: a hash of every script
// and shader and of the files that they name in the frames of the run, the variables of the environment that these
// depend on, and the options (see inventory.h); when any of it differs the pixels do, so that a locked run is refused.
// Its `made_with` names program, libraries, device, driver and way of execution: the look is the same with others,
// pixels are so within the bounds of docs/determinism.md, so that a difference is a warning.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "batch/inventory.h"
#include "core/diagnostics.h"
#include "core/result.h"
#include "session/session.h"

namespace afterglow {

/// Options that change pixels, by name.
using PixelOptions = std::vector<std::pair<std::string, std::string>>;

struct Lock {
  int version = 2;                           ///< of the file
  std::string preset;                        ///< name of its file
  std::map<std::string, std::string> files;  ///< hash by name: "effects/glow.lua", "installation: shaders/…"
  /// The same for files that other frames need not use: a run of some of the frames agrees with the lock of all.
  std::map<std::string, std::string> frame_files;
  std::map<std::string, std::string> environment;  ///< see Dependencies
  std::map<std::string, std::string> generated;    ///< the same; a difference is a warning
  std::map<std::string, std::string> options;      ///< those that are not empty
  std::map<std::string, std::string> made_with;
};

/// Of a session and what its frames are made of. Errors: script, io.
Result<Lock> lock_of(Session& session, const Inventory& inventory, const PixelOptions& options);
/// The same without a device: `made_with` says nothing of it. `file` is the preset's.
Result<Lock> look_lock(const Preset& preset, const std::filesystem::path& file, const Inventory& inventory,
                       const PixelOptions& options);

std::string lock_text(const Lock& lock);
/// Errors: io (no such file, no lock, a lock of a later version).
Result<Lock> read_lock(const std::filesystem::path& file);

/// What `now` has otherwise than `locked`. Errors: script, naming every file and option of the look that differs.
/// Differences of what it was made with are warnings, as far as `locked` says what that was.
Result<void> hold_against(const Lock& locked, const Lock& now, const std::filesystem::path& file,
                          Diagnostics& diagnostics);

}  // namespace afterglow
