// SPDX-License-Identifier: MIT
// Fields of text: Enter, Tab and a click elsewhere take what stands in them, Escape leaves the text as it was.
#pragma once

#include <imgui.h>

#include <array>
#include <list>
#include <optional>
#include <string>

namespace afterglow {

/// Of all that are open. Drawing thread alone.
class TypedText {
 public:
  static constexpr std::size_t kMost = 4096;  ///< bytes
  /// At the cursor. `most`: bytes that may be typed, up to kMost. A text once another one was entered.
  std::optional<std::string> draw(const char* name, const std::string& value, std::size_t most);

 private:
  struct Field {
    ImGuiID item;
    std::array<char, kMost + 1> text;
    std::string opened_with = {};  ///< the value may be another one since
  };
  std::list<Field> fields_;  ///< two while the keyboard goes from one to the next
};

}  // namespace afterglow
