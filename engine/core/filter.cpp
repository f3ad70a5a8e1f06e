// SPDX-License-Identifier: MIT
#include "core/filter.h"

#include <fmt/format.h>

namespace afterglow {

std::string Filter::text() const {
  static constexpr const char* kNames[] = {"nearest", "linear", "cubic_bspline"};
  std::string out = kNames[static_cast<int>(interpolation)];
  if (edges == Edges::mirror) out += " mirror";
  if (!taps.empty()) {
    for (const auto& t : taps) out += fmt::format(" ({},{}):{}", t.dx, t.dy, t.weight);
    return out;
  }
  out += " x";
  for (const auto& t : x) out += fmt::format(" {}:{}", t.offset, t.weight);
  out += " y";
  for (const auto& t : y) out += fmt::format(" {}:{}", t.offset, t.weight);
  return out;
}

}  // namespace afterglow
