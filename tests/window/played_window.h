// SPDX-License-Identifier: MIT
// `afterglow play` in a window, as users run it.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace afterglow {

/// Runs until it ends or the object does. What it prints goes to a file.
class PlayedWindow {
 public:
  PlayedWindow(const std::string& display, const std::filesystem::path& folder, std::vector<std::string> arguments);
  ~PlayedWindow();
  PlayedWindow(const PlayedWindow&) = delete;
  PlayedWindow& operator=(const PlayedWindow&) = delete;

  /// Until the program prints a line with `text`, from the last line found on. False: it has ended, or 60 s went by.
  bool wait_for(const std::string& text);
  /// Until it ends; its exit code. −1: it did not within 60 s.
  int finish();
  std::string printed() const;
  bool runs();
  pid_t pid() const { return pid_; }

 private:
  pid_t pid_ = -1;
  int status_ = -1;
  std::filesystem::path log_;
  std::size_t read_ = 0;
};

/// Asks every few milliseconds until it is so. False: 60 s went by.
bool until(const std::function<bool()>& so);

}  // namespace afterglow
