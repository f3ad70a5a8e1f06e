// SPDX-License-Identifier: MIT
// Writes frames as they are shown, whole and full size, beside the playing.
#pragma once

#include <filesystem>
#include <future>
#include <map>
#include <string>
#include <vector>

#include "play/player.h"
#include "window/ui.h"

namespace afterglow {

/// Drawing thread alone; files are written on threads of their own.
class FrameExport {
 public:
  /// `to`: a file (out.####.png takes the frame's number), a folder (NAME_graded.exr in it; one that ends in '/' is
  /// made) or a video (NAME_graded.exr beside it).
  FrameExport(std::filesystem::path to, Diagnostics& diagnostics) : to_(std::move(to)), diagnostics_(diagnostics) {}
  /// Waits for what is being written.
  ~FrameExport() = default;

  /// Takes the frame from the device and begins to write it. Files that are there stay: the frame gets a name that is
  /// free, but for its own file of before, which it replaces. What is played is never written over.
  void begin(Player& player, Ui& ui);
  /// In each turn: tells what was written or why not.
  void poll(Ui& ui);
  /// The file that the shown frame goes to, where nothing lies in its place.
  Result<std::filesystem::path> file_for(const Player& player) const;

 private:
  struct Written {
    std::filesystem::path file;
    Result<void> done;
  };
  Result<std::filesystem::path> free_file(Player& player);

  std::filesystem::path to_;
  Diagnostics& diagnostics_;
  std::map<std::filesystem::path, std::string> mine_;  ///< which frame went to a file
  std::vector<std::future<Written>> running_;
};

}  // namespace afterglow
