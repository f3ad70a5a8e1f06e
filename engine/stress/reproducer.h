// SPDX-License-Identifier: MIT
// A failing case as a folder that anybody can run again: input.exr, preset.lua, case.json, README.txt.
#pragma once

#include <filesystem>

#include "stress/check.h"

namespace afterglow::stress {

/// Where the case came from, for whoever reads the folder.
struct Provenance {
  std::string version, device, driver;
  std::uint64_t seed = 0, trial = 0;
};

/// Writes the folder, which must not exist. Errors: io.
Result<void> write_reproducer(const std::filesystem::path& folder, const Situation& situation, const Outcome& outcome,
                              const Provenance& provenance);

/// Reads it back. The stack comes from case.json; preset.lua is the same for `afterglow run`. Errors: io (not such a
/// folder; what is wrong with it).
Result<Situation> read_reproducer(const std::filesystem::path& folder, Diagnostics& diagnostics);

}  // namespace afterglow::stress
