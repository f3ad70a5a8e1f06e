// SPDX-License-Identifier: MIT
// How large a picture may be; refused from the header, before anything is allocated.
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/geometry.h"
#include "core/result.h"

namespace afterglow {

struct SizeLimits {
  int max_side = 16384;
  std::uint64_t max_bytes = 6ull << 30;
};

/// Errors: io ("its data window is W×H, larger than …"; "has no pixels").
Result<void> check_sides(const Rect& window, const char* what, const SizeLimits& limits,
                         const std::filesystem::path& file);

}  // namespace afterglow
