// SPDX-License-Identifier: MIT
#include "stress/processes.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

extern char** environ;

namespace afterglow::stress {
namespace {

Error failed(const std::string& what, int code) {
  return Error{ErrorKind::other, fmt::format("{}: {}", what, std::strerror(code))};
}

std::vector<std::string> merged(const Environment& added) {
  std::vector<std::string> out;
  for (char** one = environ; *one; ++one) {
    const std::string text = *one;
    const bool replaced = std::ranges::any_of(added, [&](const auto& a) { return text.starts_with(a.first + "="); });
    if (!replaced) out.push_back(text);
  }
  for (const auto& [name, value] : added) out.push_back(name + "=" + value);
  return out;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> out;
  for (auto& text : texts) out.push_back(text.data());
  out.push_back(nullptr);
  return out;
}

std::string read_all(int file) {
  std::string out;
  char buffer[4096];
  for (ssize_t n = 0; (n = read(file, buffer, sizeof buffer)) != 0;) {
    if (n < 0 && errno != EINTR) break;
    if (n > 0) out.append(buffer, static_cast<std::size_t>(n));
  }
  return out;
}

}  // namespace

Result<std::string> output_of(const std::string& program, const std::vector<std::string>& arguments,
                              const Environment& environment) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return failed("no pipe", errno);
  std::vector<std::string> words{program}, settings = merged(environment);
  words.insert(words.end(), arguments.begin(), arguments.end());
  auto argv = pointers(words), envp = pointers(settings);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  pid_t child = 0;
  const int problem = posix_spawn(&child, program.c_str(), &actions, nullptr, argv.data(), envp.data());
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  if (problem != 0) {
    close(ends[0]);
    return failed(fmt::format("'{}' cannot be started", program), problem);
  }
  std::string out = read_all(ends[0]);
  close(ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return out;
  return Error{ErrorKind::other, WIFEXITED(status)
                                     ? fmt::format("'{}' ended with exit code {}", program, WEXITSTATUS(status))
                                     : fmt::format("'{}' was ended by signal {}", program, WTERMSIG(status))};
}

}  // namespace afterglow::stress
