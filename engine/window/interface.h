// SPDX-License-Identifier: MIT
// Dear ImGui: its context, fonts and style for a window.
#pragma once

#include <imgui.h>

#include <memory>
#include <vector>

#include "core/geometry.h"
#include "core/result.h"
#include "window/ui.h"

struct GLFWwindow;

namespace afterglow {

/// Owns the ImGui context (one in a process). Drawing thread alone.
class Interface {
 public:
  /// With a window: listens to it besides whoever did before, and takes its sizes. Without one: for tests; the size is
  /// given to `begin`.
  explicit Interface(GLFWwindow* window);
  ~Interface();
  Interface(const Interface&) = delete;
  Interface& operator=(const Interface&) = delete;

  /// Fonts and sizes for that many pixels to a plain display's one; true when they have changed, and the atlas must be
  /// taken anew.
  bool set_scale(float scale);
  /// `size`, `seconds` since the frame before: used without a window.
  void begin(Size size = {}, float seconds = 1.0f / 60);
  const ImDrawData& end();

  /// A key (GLFW_KEY_…) went down: the next frame sees it so, though it may be up again by then. Dear ImGui looks at
  /// keys once a frame, and a frame may take longer than a press.
  void note_press(int key);

  Ui& ui() { return ui_; }
  bool wants_keyboard() const;  ///< a text is being typed: keys are no shortcuts
  bool wants_mouse() const;     ///< the pointer is on the interface, or holds a part of it

 private:
  void load_fonts();
  void hold_pressed();
  void release_held();
  ImGuiContext* context_ = nullptr;
  bool has_window_ = false;
  std::vector<int> pressed_, held_;  ///< since the last frame; only for this one
  Ui ui_;
};

}  // namespace afterglow
