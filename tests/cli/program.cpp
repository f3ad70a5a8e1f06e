// SPDX-License-Identifier: MIT
#include "program.h"

#include <fcntl.h>
#include <linux/capability.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>

namespace afterglow::test {
namespace {

[[noreturn]] void become(const std::vector<std::string>& arguments, const RunOptions& options, int out, int err) {
  dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
  dup2(out, STDOUT_FILENO);
  dup2(err, STDERR_FILENO);
  if (!options.folder.empty() && chdir(options.folder.c_str()) != 0) _exit(126);
  for (const auto& [name, value] : options.environment)
    value.empty() ? unsetenv(name.c_str()) : setenv(name.c_str(), value.c_str(), 1);
  if (options.largest_file > 0) {
    const rlimit limit{static_cast<rlim_t>(options.largest_file), static_cast<rlim_t>(options.largest_file)};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGXCPU})  // a shell that runs tests behind it has them ignored
    std::signal(signal, signal == options.ignored ? SIG_IGN : SIG_DFL);
  if (options.bound)
    for (const int right : {CAP_DAC_OVERRIDE, CAP_DAC_READ_SEARCH}) prctl(PR_CAPBSET_DROP, right);
  const std::string program = options.program.empty() ? AFTERGLOW_PROGRAM : options.program;
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (const auto& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  execvp(program.c_str(), argv.data());
  _exit(127);
}

/// Takes what there is to read; false at the end of the stream.
bool drain(int fd, std::string& into) {
  char buffer[16384];
  const ssize_t count = read(fd, buffer, sizeof buffer);
  if (count > 0) into.append(buffer, static_cast<std::size_t>(count));
  return count > 0 || (count < 0 && errno == EINTR);
}

}  // namespace

Outcome run_program(const std::vector<std::string>& arguments, const RunOptions& options) {
  int out[2], err[2];
  if (pipe2(out, O_CLOEXEC) != 0 || pipe2(err, O_CLOEXEC) != 0) std::abort();
  const auto start = std::chrono::steady_clock::now();
  const auto elapsed = [&] { return std::chrono::steady_clock::now() - start; };
  const pid_t child = fork();
  if (child == 0) become(arguments, options, out[1], err[1]);
  close(out[1]);
  close(err[1]);

  Outcome outcome;
  bool killed = false, waiting = static_cast<bool>(options.meanwhile);
  pollfd streams[2] = {{out[0], POLLIN, 0}, {err[0], POLLIN, 0}};
  while (streams[0].fd >= 0 || streams[1].fd >= 0) {
    poll(streams, 2, waiting ? 10 : 100);
    if (streams[0].revents != 0 && !drain(out[0], outcome.out)) streams[0].fd = -1;
    if (streams[1].revents != 0 && !drain(err[0], outcome.err)) streams[1].fd = -1;
    if (waiting) waiting = !options.meanwhile(child);
    if (!killed && elapsed() > options.limit) {
      kill(child, SIGKILL);
      killed = true;
    }
  }
  close(out[0]);
  close(err[0]);
  int status = 0;
  waitpid(child, &status, 0);
  outcome.exit_code = killed ? -1 : WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  outcome.seconds = std::chrono::duration<double>(elapsed()).count();
  return outcome;
}

}  // namespace afterglow::test
