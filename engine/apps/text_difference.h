// SPDX-License-Identifier: MIT
// What changed between two texts, as `diff -u` shows it, without lines around it.
#pragma once

#include <string>

namespace afterglow {

/// One block for each run of changed lines: "FILE:LINE", then the old lines with "-" and the new with "+" before them.
/// LINE is that in the new text.
std::string difference_text(const std::string& file, const std::string& before, const std::string& after);

}  // namespace afterglow
