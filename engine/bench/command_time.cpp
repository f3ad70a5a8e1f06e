// SPDX-License-Identifier: MIT
#include "bench/command_time.h"

#include <fmt/format.h>

#include <chrono>

#include "core/process.h"

namespace afterglow::bench {

Result<double> time_command(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                            const std::map<std::string, std::string>& environment) {
  std::vector<std::string> words{program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const auto start = std::chrono::steady_clock::now();
  AFTERGLOW_TRY(const ProcessEnd end, run_process(words, {.environment = environment}));
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (end.code != 0)
    return Error{ErrorKind::other, fmt::format("{} {} {}", words[0], words.size() > 1 ? words[1] : "", end.text())};
  return seconds;
}

}  // namespace afterglow::bench
