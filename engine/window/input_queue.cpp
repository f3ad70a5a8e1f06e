// SPDX-License-Identifier: MIT
#include "window/input_queue.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace afterglow {
namespace {

/// Keys that say something to a text field beyond their character: Enter, arrows, Ctrl+V.
bool is_special(const InputEvent& event) {
  return event.code >= GLFW_KEY_ESCAPE || (event.mods & (GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER)) != 0;
}

}  // namespace

bool InputQueue::fits(const InputEvent& event, bool typing) const {
  using Kind = InputEvent::Kind;
  switch (event.kind) {
    case Kind::move:
    case Kind::leave:
      return frame_.buttons == 0 && !frame_.wheel;
    case Kind::button:
      return (frame_.buttons & (1u << event.code)) == 0 && !frame_.wheel && !frame_.special_key && !frame_.text;
    case Kind::wheel:
      return frame_.buttons == 0;
    case Kind::key:
      if (!event.down) return !(typing && frame_.special_key);  // the frame sees what is down, once
      if (frame_.buttons != 0) return false;
      return !typing || !(frame_.special_key || ((frame_.text || frame_.special_up) && is_special(event)));
    case Kind::text:
      return frame_.buttons == 0 && !(typing && frame_.special_key);
    case Kind::focus:
      return frame_.buttons == 0;
  }
  return true;
}

std::optional<InputEvent> InputQueue::next(bool typing) {
  if (events_.empty() || !fits(events_.front(), typing)) return std::nullopt;
  const InputEvent event = events_.front();
  events_.pop_front();
  using Kind = InputEvent::Kind;
  if (event.kind == Kind::button) frame_.buttons |= 1u << event.code;
  if (event.kind == Kind::wheel) frame_.wheel = true;
  if (event.kind == Kind::text) frame_.text = true;
  if (event.kind == Kind::key && is_special(event)) (event.down ? frame_.special_key : frame_.special_up) = true;
  return event;
}

}  // namespace afterglow
