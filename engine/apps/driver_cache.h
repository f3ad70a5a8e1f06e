// SPDX-License-Identifier: MIT
// The cache of compiled shaders that Mesa's drivers keep for themselves. They write to a file of it that they have
// mapped: on a full disk, or over a quota, the program would be killed (SIGBUS).
#pragma once

#include <optional>
#include <string>

namespace afterglow {

/// Turns that cache off, in the environment, where its folder has no room for it or cannot be written to, which drivers
/// say on standard error for each device. Before there are other threads, and
/// before a driver is loaded. What to tell of it, if it was done.
std::optional<std::string> avoid_full_driver_cache();

}  // namespace afterglow
