// SPDX-License-Identifier: MIT
// What a desktop does to a window: asks it to close, drops files on it. Of X11, directly.
#pragma once

#include <filesystem>
#include <string>

#include "core/geometry.h"

namespace afterglow {

/// Sends WM_DELETE_WINDOW to the program's window. False: there is no such window.
bool ask_to_close(const std::string& display);

/// Drags a file onto the middle of the program's window (XDND 5) and drops it. False: no window, or it does not want
/// it.
bool drop_file(const std::string& display, const std::filesystem::path& file);

/// What desktops say of their screens ("Xft.dpi"); programs that start later read it. False: no display.
bool set_dots_per_inch(const std::string& display, int dots);

/// The title of the program's window.
std::string window_title(const std::string& display);

/// Where the program's window is on the screen; empty: there is none.
Rect window_place(const std::string& display);

}  // namespace afterglow
