// SPDX-License-Identifier: MIT
// Dear ImGui: its context, fonts and style for a window.
#pragma once

#include <imgui.h>

#include <array>
#include <memory>

#include "core/geometry.h"
#include "core/result.h"
#include "window/input_event.h"
#include "window/ui.h"

struct GLFWcursor;
struct GLFWwindow;

namespace afterglow {

/// Owns the ImGui context (one in a process). Drawing thread alone.
class Interface {
 public:
  /// With a window: keys are read as it names them, and it shows the pointer's shape. Without one: for tests.
  explicit Interface(GLFWwindow* window);
  ~Interface();
  Interface(const Interface&) = delete;
  Interface& operator=(const Interface&) = delete;

  /// Fonts and sizes for that many pixels to a plain display's one; true when they have changed, and the atlas must be
  /// taken anew.
  bool set_scale(float scale);
  /// `size` in the units of the pointer, `framebuffer` in pixels. Asks the window nothing.
  void begin(Size size, Size framebuffer);
  void begin(Size size) { begin(size, size); }
  const ImDrawData& end();

  /// For the next frame; with a window alone. Events of one frame are those of InputQueue.
  void feed(const InputEvent& event);

  Ui& ui() { return ui_; }
  /// Keys choose and change items of the window of that name (arrows, Space, Enter); empty: no longer.
  void navigate(const char* window);
  /// Something is held, typed or open that Escape ends first.
  bool holds_something() const;
  /// Closes menus, lists of choices and pickers of colours that are open; false: there was none. Not within a frame.
  bool close_popups();
  bool wants_keyboard() const;  ///< a text is being typed, or is from the next frame on: keys are no shortcuts
  int press_mods() const { return pressed_.mods; }  ///< GLFW_MOD_… of the last press of a button
  bool wants_mouse() const;                         ///< the pointer is on the interface, or holds a part of it

 private:
  void load_fonts();
  void take_pointer();
  void show_pointer();
  void note_press(const InputEvent& event);
  ImGuiContext* context_ = nullptr;
  GLFWwindow* window_ = nullptr;
  std::array<GLFWcursor*, ImGuiMouseCursor_COUNT> shapes_{};  ///< of the pointer; null: the arrow
  GLFWcursor* shape_ = nullptr;                               ///< that is shown
  double began_ = 0;                                          ///< the frame, by GLFW's clock
  ImVec2 pointer_;                                            ///< in the window; off-screen: it is elsewhere
  std::array<bool, 5> buttons_{};                             ///< that are down
  InputEvent pressed_;                                        ///< the last press of a button
  ImVec2 pressed_at_;
  bool twice_ = false;  ///< that press follows another one at once, at the same place
  Ui ui_;
};

}  // namespace afterglow
