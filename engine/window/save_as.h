// SPDX-License-Identifier: MIT
// Asks for the file that a preset is saved as.
#pragma once

#include <array>
#include <filesystem>
#include <optional>

#include "window/ui.h"

namespace afterglow {

/// A window over the picture. Drawing thread alone.
class SaveAs {
 public:
  /// Opens with the keyboard in its field, which holds a free name beside `preset`.
  void open(const std::filesystem::path& preset);
  bool is_open() const { return open_; }
  void close() { open_ = false; }
  /// The file, once it was entered; one that exists is asked about first. Relative names are of the preset's folder.
  std::optional<std::filesystem::path> draw(Ui& ui, ImVec2 area);

 private:
  bool open_ = false, begin_ = false;
  std::filesystem::path folder_, asked_;  ///< asked_: a file that exists, to be entered once more
  std::array<char, 512> text_{};
};

/// NAME_2.lua, NAME_3.lua, …: the first that no file has.
std::filesystem::path free_name(const std::filesystem::path& preset);

}  // namespace afterglow
