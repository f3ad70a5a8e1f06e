// SPDX-License-Identifier: MIT
// A picture with its auxiliary inputs as one EXR file of full floats, so that what was found can be found again.
#pragma once

#include <filesystem>

#include "core/diagnostics.h"
#include "core/result.h"
#include "image/picture.h"

namespace afterglow::stress {

/// Channels R, G, B, A, Z, N.X…, motion.x…, as `run` finds them. Errors: io.
Result<void> write_picture_file(const Picture& picture, const std::filesystem::path& file);

/// Reads it as `run` does, with all auxiliary inputs: finite afterwards. Errors: io.
Result<Picture> read_picture_file(const std::filesystem::path& file, Diagnostics& diagnostics);

}  // namespace afterglow::stress
