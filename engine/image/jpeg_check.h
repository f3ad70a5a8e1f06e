// SPDX-License-Identifier: MIT
// Internal to the room.
#pragma once

#include <filesystem>
#include <fstream>

#include "image/container_check.h"

namespace afterglow {

/// Walks the segments, and the entropy-coded data for its end marker. Errors: io (malformed, truncated; metadata that
/// OpenImageIO 2.4 reads beyond its end).
Result<ContainerFacts> check_jpeg(const std::filesystem::path& file, std::ifstream& in, std::uint64_t size);

}  // namespace afterglow
