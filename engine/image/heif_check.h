// SPDX-License-Identifier: MIT
// HEIF pictures that decode to another size than they claim: OpenImageIO 2.4 reads beyond what was decoded. Internal to
// the room, in its OpenImageIO module.
#pragma once

#include <filesystem>

#include "core/result.h"

namespace afterglow {

/// Decodes it by the libheif that OpenImageIO has loaded. Errors: io.
Result<void> check_heif(const std::filesystem::path& file);

}  // namespace afterglow
