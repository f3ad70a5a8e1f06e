// SPDX-License-Identifier: MIT
#include "played_window.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>

namespace afterglow {

bool until(const std::function<bool()>& so) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!so()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

PlayedWindow::PlayedWindow(const std::string& display, const std::filesystem::path& folder,
                           std::vector<std::string> arguments)
    : log_(folder / "printed.txt") {
  arguments.insert(arguments.begin(), {AFTERGLOW_PROGRAM, "play"});
  arguments.emplace_back("-v");
  std::vector<char*> argv;
  for (auto& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ != 0) return;
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);
  const int file = open(log_.c_str(), O_CREAT | O_TRUNC | O_WRONLY | O_APPEND, 0644);
  dup2(file, STDOUT_FILENO);
  dup2(file, STDERR_FILENO);
  setenv("DISPLAY", display.c_str(), 1);
  unsetenv("WAYLAND_DISPLAY");
  setenv("AFTERGLOW_VALIDATE", "1", 1);
  for (const char* folder : {"XDG_CONFIG_HOME", "XDG_STATE_HOME"}) setenv(folder, log_.parent_path().c_str(), 1);
  setenv("AFTERGLOW_EDITOR", "./editor", 1);
  setenv("AFTERGLOW_HOME", AFTERGLOW_PROJECT_FOLDER, 1);
  if (chdir(folder.c_str()) != 0) _exit(1);
  execv(argv[0], argv.data());
  _exit(127);
}

PlayedWindow::~PlayedWindow() {
  if (!runs()) return;
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
}

bool PlayedWindow::runs() {
  if (pid_ <= 0) return false;
  int status = 0;
  if (waitpid(pid_, &status, WNOHANG) != pid_) return true;
  status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  pid_ = -1;
  return false;
}

int PlayedWindow::finish() {
  return until([this] { return !runs(); }) ? status_ : -1;
}

std::string PlayedWindow::printed() const {
  std::ifstream file(log_);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

bool PlayedWindow::wait_for(const std::string& text) {
  bool found = false;
  until([&] {
    const bool alive = runs();  // asked first: what it printed last is then there to be read
    const std::string all = printed();
    const std::size_t at = all.find(text, read_);
    if (at != std::string::npos) {
      read_ = at + text.size();
      found = true;
    }
    return found || !alive;
  });
  return found;
}

}  // namespace afterglow
