// SPDX-License-Identifier: MIT
// The field above a list that is typed into to search it, while Up and Down go through the list.
#pragma once

#include <array>
#include <cstddef>

#include "window/ui.h"

namespace afterglow {

/// What a frame did to a search field.
struct SearchTurn {
  bool entered = false;  ///< by Enter
  bool left = false;     ///< by Escape
  bool changed = false;  ///< another text
  int step = 0;          ///< −1 by Up, 1 by Down; the field keeps the keyboard

  /// Goes to the item that the frame leads to, in a list of `count` items. True: it was led somewhere.
  bool go(std::size_t& chosen, std::size_t count) const;
};

/// Drawing thread alone.
class SearchField {
 public:
  /// Empty, with the keyboard from the next frame on.
  void open() {
    text_.fill(0);
    begin_ = true;
  }
  /// It gets the keyboard again: Enter and the arrows go on from here.
  void take_keyboard(Ui& ui) { begin_ = ui.field_opens = true; }
  /// As wide as the window. `name` is unique among those drawn in the same ID scope.
  SearchTurn draw(Ui& ui, const char* name, const char* hint);
  const char* text() const { return text_.data(); }

 private:
  std::array<char, 64> text_{};
  bool begin_ = false;
};

}  // namespace afterglow
