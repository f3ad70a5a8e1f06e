// SPDX-License-Identifier: MIT
#include "supervisor.h"

#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>

namespace afterglow::test {
namespace {

[[noreturn]] void become_program(const std::vector<std::string>& words) {
  for (const int changed : {SIGCHLD, SIGINT, SIGTERM, SIGHUP}) signal(changed, SIG_DFL);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int nothing = open("/dev/null", O_RDWR);
  for (const int stream : {0, 1, 2}) dup2(nothing, stream);
  std::vector<char*> arguments;
  for (const auto& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  execvp(arguments[0], arguments.data());
  _exit(127);
}

/// Kills the children of this process; those of theirs become children of this one then.
void kill_children() {
  DIR* folder = opendir("/proc");
  while (const dirent* entry = folder ? readdir(folder) : nullptr) {
    const int process = std::atoi(entry->d_name);
    if (process <= 0) continue;
    char name[64], text[512];
    std::snprintf(name, sizeof name, "/proc/%d/stat", process);
    FILE* file = std::fopen(name, "r");
    if (!file) continue;
    const std::size_t size = std::fread(text, 1, sizeof text - 1, file);
    std::fclose(file);
    text[size] = '\0';
    const std::string status = text;  // "12 (name) S 11 …"; names may hold anything
    int parent = 0;
    if (const auto end = status.rfind(')'); end != std::string::npos && status.size() > end + 4)
      parent = std::atoi(status.c_str() + end + 4);
    if (parent == getpid()) kill(process, SIGKILL);
  }
  if (folder) closedir(folder);
}

[[noreturn]] void supervise(int commands, const std::vector<std::vector<std::string>>& programs) {
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  prctl(PR_SET_NAME, "farm-test-nodes");
  signal(SIGCHLD, SIG_IGN);  // what ends is gone at once, whoever it was
  signal(SIGINT, SIG_IGN);   // of a terminal: the test ends, and this by it
  unsigned char program = 0;
  for (ssize_t count = 0; (count = read(commands, &program, 1)) != 0;) {
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) break;
    if (fork() == 0) {
      close(commands);
      setpgid(0, 0);
      become_program(programs[program]);
    }
  }
  for (;;) {
    kill_children();
    if (waitpid(-1, nullptr, 0) < 0 && errno == ECHILD) _exit(0);
  }
}

}  // namespace

Supervisor::Supervisor(const std::vector<std::vector<std::string>>& programs) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) std::abort();
  process_ = fork();
  if (process_ == 0) {
    close(ends[1]);
    supervise(ends[0], programs);
  }
  close(ends[0]);
  commands_ = ends[1];
}

Supervisor::~Supervisor() {
  close(commands_);
  waitpid(process_, nullptr, 0);
}

void Supervisor::start(std::size_t program) const {
  const auto byte = static_cast<unsigned char>(program);
  if (write(commands_, &byte, 1) != 1) std::abort();
}

}  // namespace afterglow::test
