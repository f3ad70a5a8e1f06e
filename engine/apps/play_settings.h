// SPDX-License-Identifier: MIT
// What a user wants of every window of `play`: options in a file of their own.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"

namespace afterglow {

/// $XDG_CONFIG_HOME/afterglow/play.conf; empty: there is no home.
std::filesystem::path play_settings_file();
/// Options that may stand in it, without their dashes.
const std::vector<std::string>& play_settings();
/// Gives the command those options of `text` that the command line does not have: lines "name = value", comments behind
/// "#". `file` is for messages. Errors: usage (no such option, a value that it cannot have).
Result<void> apply_play_settings(CLI::App& command, const std::string& text, const std::string& file);

}  // namespace afterglow
