// SPDX-License-Identifier: MIT
// Runs the built program as a user would, and keeps what came of it.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace afterglow::test {

struct Outcome {
  int exit_code = -1;  ///< 128 + N when a signal N ended it; -1: it had to be killed after the time limit
  std::string out, err;
  double seconds = 0;
};

struct RunOptions {
  std::filesystem::path folder{};                    ///< working folder; empty: that of the test
  std::map<std::string, std::string> environment{};  ///< added to the test's own; an empty text removes
  std::string program{};                             ///< empty: the built program
  int ignored = 0;                                   ///< a signal that the program is told to ignore; 0: none
  bool bound = false;                                ///< modes of files bind the program, also when root runs it
  long long largest_file = 0;                        ///< bytes a file may have (RLIMIT_FSIZE); 0: no limit
  /// Called with the process id about every 10 ms until it returns true or the program ends.
  std::function<bool(int)> meanwhile{};
  std::chrono::seconds limit{120};
};

Outcome run_program(const std::vector<std::string>& arguments, const RunOptions& options = {});

}  // namespace afterglow::test
