// SPDX-License-Identifier: MIT
// A window of the desktop, through GLFW.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry.h"
#include "core/result.h"
#include "gpu/device.h"
#include "window/input_event.h"

struct GLFWwindow;

namespace afterglow {

/// What has happened since the events were taken last.
struct WindowEvents {
  bool any = false;      ///< anything at all: something may look different
  bool exposed = false;  ///< what the window showed may be lost
  bool close = false;    ///< the desktop asks the window to close
  std::vector<InputEvent> input;
  std::vector<std::filesystem::path> dropped;
};

/// The key (GLFW_KEY_…) whose letter or sign of shortcuts a key has in the layout that is in use, by its name there
/// ("a", "+"); others stay what they are.
int key_of_letter(int key, const char* name);

/// One at a time in a process; main thread alone, except where noted.
class DesktopWindow {
 public:
  /// Not visible until `show`. `size` counts pixels of a plain display, or (`exact`) of this one. Errors: device (no
  /// display, no Vulkan in windows).
  static Result<std::unique_ptr<DesktopWindow>> create(const std::string& title, Size size, bool exact = false);
  ~DesktopWindow();
  DesktopWindow(const DesktopWindow&) = delete;
  DesktopWindow& operator=(const DesktopWindow&) = delete;

  /// For DeviceOptions::presentation. The window must outlive the device.
  std::shared_ptr<const Presentation> presentation() const;
  GLFWwindow* handle() const { return window_; }

  void show();
  void hide();
  /// Shows it again where it is minimised, and asks for attention.
  void restore();
  /// Of its upper left corner, on the desktop. A place that no monitor shows is left to the desktop.
  void move_to(int x, int y);
  /// Where it is, or was before it filled the screen. On desktops that tell nobody, x and y are 0.
  Rect place() const;
  void set_title(const std::string& title);
  struct Extent {
    Size window;       ///< in the units that places of the pointer have
    Size framebuffer;  ///< in pixels
  };
  /// Both empty while minimised.
  Extent extent() const;
  /// Pixels for what is a pixel on a plain display: 1, 1.5, 2, …
  float content_scale() const;
  void set_full_screen(bool on);
  bool full_screen() const { return full_screen_; }
  void set_clipboard(const std::string& text);
  /// Called once when the display goes away, with no other work of the main thread under way; then the process ends
  /// with exit code 5, because neither Xlib nor GLFW can go on without it. For what has to be written. It must not use
  /// the window.
  void set_last_words(std::function<void()> say);

  /// Handles events; blocks until one comes, `wake` is called or `seconds` have passed (0: not at all; infinity: as
  /// long as it takes).
  void wait(double seconds);
  WindowEvents take_events();
  /// Ends a `wait` that runs or comes next. Any thread, as long as a window exists.
  static void wake();

 private:
  DesktopWindow() = default;
  static void on_key(GLFWwindow* window, int key, int scancode, int action, int mods);
  static void on_text(GLFWwindow* window, unsigned character);
  static void on_move(GLFWwindow* window, double x, double y);
  static void on_enter(GLFWwindow* window, int entered);
  static void on_button(GLFWwindow* window, int button, int action, int mods);
  static void on_wheel(GLFWwindow* window, double x, double y);
  static void on_focus(GLFWwindow* window, int focused);
  static void on_drop(GLFWwindow* window, int count, const char** paths);
  static void on_close(GLFWwindow* window);
  void listen();
  void size_changes();
  static void take(GLFWwindow* window, const InputEvent& event);

  GLFWwindow* window_ = nullptr;
  WindowEvents events_;
  mutable std::optional<Extent> extent_;  ///< none: it may be another than before
  bool full_screen_ = false;
  Rect windowed_;  ///< where it was before it filled the screen
};

}  // namespace afterglow
