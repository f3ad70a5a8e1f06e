// SPDX-License-Identifier: MIT
#include "image/size_limits.h"

#include <fmt/format.h>

namespace afterglow {

Result<void> check_sides(const Rect& window, const char* what, const SizeLimits& limits,
                         const std::filesystem::path& file) {
  if (window.width < 1 || window.height < 1) return Error{ErrorKind::io, "has no pixels", file.string()};
  if (window.width <= limits.max_side && window.height <= limits.max_side) return {};
  return Error{
      ErrorKind::io,
      fmt::format("its {} is {}×{}, larger than {} a side", what, window.width, window.height, limits.max_side),
      file.string()};
}

}  // namespace afterglow
