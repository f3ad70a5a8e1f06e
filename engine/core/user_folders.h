// SPDX-License-Identifier: MIT
// Folders of the XDG base directories that belong to a user.
#pragma once

#include <filesystem>

namespace afterglow {

/// What users set up for themselves: $XDG_CONFIG_HOME/afterglow, else ~/.config/afterglow. Empty: there is no home.
std::filesystem::path config_folder();
/// What can be made again: $XDG_CACHE_HOME/afterglow, else ~/.cache/afterglow. Empty: there is no home.
std::filesystem::path user_cache_folder();
/// What the program remembers from one call to the next: $XDG_STATE_HOME/afterglow, else ~/.local/state/afterglow.
/// Empty: there is no home.
std::filesystem::path state_folder();

}  // namespace afterglow
