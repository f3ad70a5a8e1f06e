// SPDX-License-Identifier: MIT
// Whole commands of the program, timed as a user would.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/result.h"

namespace afterglow::bench {

/// Runs a program with arguments and additional environment, its output thrown away, and waits. Returns seconds.
/// Errors: io (it cannot be started), other (it failed).
Result<double> time_command(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                            const std::map<std::string, std::string>& environment);

}  // namespace afterglow::bench
