// SPDX-License-Identifier: MIT
// Programs of the scheduler, run with words as they are: no shell reads them.
#pragma once

#include <string>
#include <vector>

#include "core/result.h"

namespace afterglow::farm {

struct ProcessEnd {
  int code = 0;  ///< exit code; 128 + N when a signal N ended it
  std::string out, err;
};

/// Runs the program `words[0]`, found on PATH, to its end; it reads nothing. Errors: io (it cannot be started).
Result<ProcessEnd> run_process(const std::vector<std::string>& words);

/// A word as shells read it: plain ones as they are, others in single quotation marks.
std::string shell_word(const std::string& word);
/// Words with blanks between.
std::string shell_line(const std::vector<std::string>& words);

}  // namespace afterglow::farm
