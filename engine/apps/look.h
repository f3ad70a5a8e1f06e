// SPDX-License-Identifier: MIT
// A preset loaded and built for an assumed picture, without a device: what `check` and `graph` look at.
#pragma once

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "apps/options.h"
#include "exec/program_cache.h"
#include "graph/plan.h"
#include "script/build.h"
#include "shader/library.h"

namespace afterglow {

struct Look {
  std::unique_ptr<ShaderLibrary> shaders;
  std::unique_ptr<Preset> preset;
  Build build;
  std::vector<EntrySpace> spaces;  ///< of the preset's entries
  Plan plan;                       ///< as `run` would make it
};

/// Errors: script, usage.
Result<Look> load_look(const PresetArguments& arguments, const AssumedPicture& assumed, Console& console);

/// Names of the passes that the next frame makes of other values, or of what such passes make.
std::set<std::string> moving_passes(const Look& look);

struct LookFindings {
  ShaderFindings shaders;
  /// Entries that the assumed frame leaves out, others may not, and that no frame that was tried has run: their shaders
  /// are not compiled.
  std::vector<std::string> not_compiled;
};

/// Compiles every kernel of the plan, from the disk cache where possible; all that is wrong with GLSL, each once. What
/// the assumed frame leaves out and others may not is looked for in some of those: 2, 3, 5, 9, … 1025.
LookFindings check_shaders(const Look& look);

/// Builds the look for pictures of two odd sizes, one of them small, without compiling anything: what is wrong there,
/// as warnings.
std::vector<std::string> check_odd_sizes(const Look& look);

}  // namespace afterglow
