// SPDX-License-Identifier: MIT
// Size and place of a window: as --geometry says, or as it was left.
#pragma once

#include <optional>
#include <string>

#include "core/geometry.h"
#include "core/result.h"

namespace afterglow {

/// In pixels of the screen.
struct WindowPlace {
  Size size;
  bool placed = false;  ///< false: where the desktop likes
  int x = 0, y = 0;
  friend bool operator==(const WindowPlace&, const WindowPlace&) = default;
};

/// "1280x720" or "1280x720+100+50". Errors: usage.
Result<WindowPlace> parse_geometry(const std::string& text);
std::string geometry_text(const WindowPlace& place);

/// Where the last window was, in the user's state folder; none: nowhere yet, or nobody can tell.
std::optional<WindowPlace> remembered_place();
/// As far as that works: a folder that cannot be written to is no reason to fail.
void remember_place(const WindowPlace& place);

}  // namespace afterglow
