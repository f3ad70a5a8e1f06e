// SPDX-License-Identifier: MIT
// HEIF and AVIF pictures before OpenImageIO 2.4 reads them: it reads beyond what was decoded where that has another
// size than they claim, and passes on nothing of their colours. Internal to the room, in its OpenImageIO module.
#pragma once

#include <filesystem>

#include "core/result.h"
#include "image/container_check.h"

namespace afterglow {

/// Decodes it by the libheif that OpenImageIO has loaded; fills in the profile and the codes of its colours. Errors:
/// io.
Result<void> check_heif(const std::filesystem::path& file, ContainerFacts& facts);

}  // namespace afterglow
