// SPDX-License-Identifier: MIT
// OpenColorIO, at arm's length: it takes longer to load than a frame takes to run, and is loaded when the first table
// or configuration is read.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"
#include "image/lut_file.h"
#include "image/ocio.h"

namespace afterglow {

/// What OpenColorIO can do and steps of ours cannot, and why. Stays within the module.
struct Unsupported {
  std::string what;
};

struct OcioModule {
  Result<Lut> (*read)(const std::filesystem::path& file, const std::string& correction);
  /// Of the formats of tables that it knows, without the point, sorted.
  std::vector<std::string> (*extensions)();
  Result<OcioSurvey> (*survey)(const OcioRequest& request);
  Result<OcioShader> (*shader)(const OcioRequest& request);
  Result<OcioFunction> (*function)(const OcioRequest& request);
  std::string (*version)();
};

/// Loads it on the first call; thread-safe. Errors: io (not installed).
Result<const OcioModule*> ocio_module();

}  // namespace afterglow
