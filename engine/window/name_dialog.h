// SPDX-License-Identifier: MIT
// Asks for the name of a file that is to be written.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "window/ui.h"

namespace afterglow {

/// A window over the picture. Drawing thread alone.
class NameDialog {
 public:
  struct Question {
    std::string title, note;  ///< note: below the field
    std::string name;         ///< that the field holds at first
    std::string button;       ///< what Enter does: "Save"
    /// What a name would write over, by its name; none: nothing. It is asked about first.
    std::function<std::optional<std::string>(const std::string& name)> in_the_way;
    bool may_be_empty = false;
  };
  /// Opens with the keyboard in its field.
  void open(Question question);
  bool is_open() const { return open_; }
  void close() { open_ = false; }
  /// The name, once it was entered.
  std::optional<std::string> draw(Ui& ui, ImVec2 area);

 private:
  Question question_;
  bool open_ = false, begin_ = false;
  std::string asked_;  ///< the name that is to be entered once more
  std::string over_;   ///< what that would write over
  std::array<char, 512> text_{};
};

/// NAME_2.lua, NAME_3.lua, …: the first that no file has.
std::filesystem::path free_name(const std::filesystem::path& preset);

}  // namespace afterglow
