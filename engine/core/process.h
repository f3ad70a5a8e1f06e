// SPDX-License-Identifier: MIT
// Other programs, run with words as they are: no shell reads them.
#pragma once

#include <spawn.h>

#include <map>
#include <string>
#include <vector>

#include "core/result.h"

namespace afterglow {

struct ProcessOptions {
  std::map<std::string, std::string> environment;  ///< these variables instead of this process's, or besides
  bool show_errors = false;  ///< its standard error goes where this process's goes, and is not collected
};

struct ProcessEnd {
  int code = 0;    ///< exit code; 128 + N when a signal N ended it
  int signal = 0;  ///< the one that ended it; 0: it ended by itself
  std::string out, err;
  /// For messages: "ended with exit code 3", "was ended by signal 9".
  std::string text() const;
};

/// Runs the program `words[0]`, found on PATH where it names no folder, to its end; it reads nothing. Thread-safe.
/// Errors: io (it cannot be started).
Result<ProcessEnd> run_process(const std::vector<std::string>& words, const ProcessOptions& options = {});

/// For posix_spawn: the program is to end by SIGPIPE and SIGXFSZ, as programs expect, though this one ignores them.
/// `more_flags`: others of the attributes.
void hear_signals(posix_spawnattr_t& attributes, short more_flags = 0);

/// A word as shells read it: plain ones as they are, others in single quotation marks.
std::string shell_word(const std::string& word);
/// Words with blanks between.
std::string shell_line(const std::vector<std::string>& words);

}  // namespace afterglow
