// SPDX-License-Identifier: MIT
// The program started again, to see whether other processes make the same bytes.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/result.h"

namespace afterglow::stress {

using Environment = std::vector<std::pair<std::string, std::string>>;

/// What a program prints on its standard output; its standard error goes where this process's goes. `environment` is
/// added to this process's. Errors: other (it cannot be started, ends with an exit code that is not 0).
Result<std::string> output_of(const std::string& program, const std::vector<std::string>& arguments,
                              const Environment& environment);

}  // namespace afterglow::stress
