// SPDX-License-Identifier: MIT
#include "core/process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>

extern char** environ;

namespace afterglow {
namespace {

/// Both ends of a pipe that children do not get by accident.
struct Pipe {
  std::array<int, 2> ends{-1, -1};
  bool open() { return pipe2(ends.data(), O_CLOEXEC) == 0; }
  void close_end(int which) {
    if (ends[which] >= 0) ::close(ends[which]);
    ends[which] = -1;
  }
  ~Pipe() {
    close_end(0);
    close_end(1);
  }
};

/// False at the end of the stream.
bool take_text(int file, std::string& into) {
  std::array<char, 16384> buffer{};
  const ssize_t count = read(file, buffer.data(), buffer.size());
  if (count > 0) into.append(buffer.data(), static_cast<std::size_t>(count));
  return count > 0 || (count < 0 && errno == EINTR);
}

/// Variables of this process, with others instead or besides.
std::vector<std::string> environment_with(const std::map<std::string, std::string>& others) {
  std::vector<std::string> out;
  for (char** variable = environ; *variable; ++variable) {
    const std::string text = *variable;
    if (!others.contains(text.substr(0, text.find('=')))) out.push_back(text);
  }
  for (const auto& [name, value] : others) out.push_back(name + "=" + value);
  return out;
}

/// As the system takes lists of words.
std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> out;
  for (auto& text : texts) out.push_back(text.data());
  out.push_back(nullptr);
  return out;
}

void read_both(Pipe& out, Pipe& err, ProcessEnd& end) {
  std::array<pollfd, 2> streams{pollfd{out.ends[0], POLLIN, 0}, pollfd{err.ends[0], POLLIN, 0}};
  while (streams[0].fd >= 0 || streams[1].fd >= 0) {
    if (poll(streams.data(), streams.size(), -1) < 0) {
      if (errno != EINTR) return;
      continue;  // what streams[i].revents says is of before
    }
    if (streams[0].revents != 0 && !take_text(streams[0].fd, end.out)) streams[0].fd = -1;
    if (streams[1].revents != 0 && !take_text(streams[1].fd, end.err)) streams[1].fd = -1;
  }
}

}  // namespace

std::string ProcessEnd::text() const {
  return signal ? fmt::format("was ended by signal {}", signal) : fmt::format("ended with exit code {}", code);
}

void hear_signals(posix_spawnattr_t& attributes, short more_flags) {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGPIPE);
  sigaddset(&signals, SIGXFSZ);
  posix_spawnattr_setsigdefault(&attributes, &signals);
  posix_spawnattr_setflags(&attributes, static_cast<short>(POSIX_SPAWN_SETSIGDEF | more_flags));
}

Result<ProcessEnd> run_process(const std::vector<std::string>& words, const ProcessOptions& options) {
  const auto failed = [&](int code) {
    return Error{ErrorKind::io, fmt::format("'{}' cannot be started: {}", words.front(), std::strerror(code))};
  };
  Pipe out, err;
  if (!out.open() || !err.open()) return failed(errno);
  std::vector<std::string> arguments = words, variables = environment_with(options.environment);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, out.ends[1], STDOUT_FILENO);
  if (!options.show_errors) posix_spawn_file_actions_adddup2(&actions, err.ends[1], STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  hear_signals(attributes);
  pid_t child = 0;
  const int problem = posix_spawnp(&child, words.front().c_str(), &actions, &attributes, pointers(arguments).data(),
                                   pointers(variables).data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (problem != 0) return failed(problem);
  out.close_end(1);
  err.close_end(1);
  ProcessEnd end;
  read_both(out, err, end);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  end.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  end.code = end.signal ? 128 + end.signal : WEXITSTATUS(status);
  return end;
}

std::string shell_word(const std::string& word) {
  const bool plain = !word.empty() && word.find_first_not_of(
                                          "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                          "_-+=./,:@%") == std::string::npos;
  if (plain) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string shell_line(const std::vector<std::string>& words) {
  std::string out;
  for (const auto& word : words) out += (out.empty() ? "" : " ") + shell_word(word);
  return out;
}

}  // namespace afterglow
