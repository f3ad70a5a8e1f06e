// SPDX-License-Identifier: MIT
// Files whose clock starts anew, as joined MPEG streams do: their parts, which are read as one after another.
#pragma once

#include <cstdint>

namespace afterglow {

/// Holds from `pos` in the file on, up to the next part.
struct ClockPart {
  std::int64_t pos = 0;
  std::int64_t shift = 0;  ///< microseconds that are added to the file's stamps
  bool operator==(const ClockPart&) const = default;
};

}  // namespace afterglow
