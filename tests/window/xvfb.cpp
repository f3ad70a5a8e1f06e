// SPDX-License-Identifier: MIT
#include "xvfb.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <sstream>

namespace afterglow {

Xvfb::Xvfb(Size screen) {
  int ends[2];
  if (pipe(ends) != 0) return;
  const std::string geometry = std::to_string(screen.width) + "x" + std::to_string(screen.height) + "x24";
  const std::string fd = std::to_string(ends[1]);
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // a test that crashes leaves nothing behind
    if (getppid() != parent) _exit(1);
    close(ends[0]);
    const int null = open("/dev/null", O_WRONLY);
    dup2(null, STDOUT_FILENO);
    dup2(null, STDERR_FILENO);
    execlp("Xvfb", "Xvfb", "-displayfd", fd.c_str(), "-screen", "0", geometry.c_str(), "-nolisten", "tcp", "-noreset",
           static_cast<char*>(nullptr));
    _exit(127);
  }
  close(ends[1]);
  // It writes its number once it listens; or ends, and the pipe with it.
  std::string number;
  char c = 0;
  while (read(ends[0], &c, 1) == 1 && c != '\n') number += c;
  close(ends[0]);
  if (number.empty()) {
    kill();
  } else {
    display_ = ":" + number;
  }
}

Xvfb::~Xvfb() { kill(); }

void Xvfb::kill() {
  if (pid_ <= 0) return;
  ::kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
  pid_ = -1;
  if (display_.empty()) return;
  // What it would have removed itself.
  unlink(("/tmp/.X" + display_.substr(1) + "-lock").c_str());
  unlink(("/tmp/.X11-unix/X" + display_.substr(1)).c_str());
}

int run_on(const std::string& display, const std::string& command, std::string* output) {
  const std::string line = "DISPLAY=" + display + " " + command + " 2>&1";
  FILE* pipe = popen(line.c_str(), "r");
  if (!pipe) return -1;
  std::string text;
  char part[4096];
  for (std::size_t n = 0; (n = fread(part, 1, sizeof part, pipe)) > 0;) text.append(part, n);
  const int status = pclose(pipe);
  if (output) *output = text;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

Screen screenshot(const std::string& display, const std::string& scratch_file) {
  Screen out;
  if (run_on(display, "import -window root -depth 8 ppm:" + scratch_file) != 0) return out;
  std::ifstream file(scratch_file, std::ios::binary);
  std::string magic;
  int most = 0;
  file >> magic >> out.size.width >> out.size.height >> most;
  file.get();
  if (magic != "P6" || most != 255) return {};
  out.rgb.resize(static_cast<std::size_t>(out.size.area()) * 3);
  file.read(reinterpret_cast<char*>(out.rgb.data()), static_cast<std::streamsize>(out.rgb.size()));
  return file ? out : Screen{};
}

}  // namespace afterglow
