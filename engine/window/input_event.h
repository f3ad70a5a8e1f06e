// SPDX-License-Identifier: MIT
// What a user did, in the order in which it happened.
#pragma once

namespace afterglow {

struct InputEvent {
  enum class Kind { move, leave, button, wheel, key, text, focus };
  Kind kind = Kind::move;
  double x = 0, y = 0;  ///< move: in the window; wheel: how far
  int code = 0;         ///< button; key (GLFW_KEY_…)
  int physical = 0;     ///< key: where it is, as on a keyboard of the USA; `code` goes by the letter that it has
  int scancode = 0;     ///< key
  bool down = false;    ///< button, key: it went down; focus: it came
  bool repeat = false;  ///< key: it is held
  int mods = 0;         ///< button, key: of GLFW_MOD_SHIFT, …_CONTROL, …_ALT, …_SUPER
  unsigned text = 0;    ///< a character, as Unicode
  double time = 0;      ///< when it was noticed, in seconds
};

}  // namespace afterglow
