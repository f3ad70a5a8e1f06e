// SPDX-License-Identifier: MIT
#include "window/desktop_window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <string_view>
#include <thread>
#include <utility>

#include "gpu/error.h"

// vulkan.h is here before <GLFW/glfw3.h> in every file, which declares these only then otherwise.
extern "C" VkResult glfwCreateWindowSurface(VkInstance instance, GLFWwindow* window,
                                            const VkAllocationCallbacks* allocator, VkSurfaceKHR* surface);

namespace afterglow {

namespace {

std::string glfw_reason() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text ? text : "no reason given";
}

Error no_display(const std::string& why) {
  Error error{ErrorKind::device, "cannot open a window: " + why};
  error.allowed = "a display (DISPLAY or WAYLAND_DISPLAY names it), or --headless to play without a window";
  return error;
}

/// The main thread has it but while it waits for events: then others may do its work.
struct MainThread {
  std::thread::id id;
  std::timed_mutex busy;
  std::function<void()> terminate_handler;
};
MainThread& main_thread() {
  static MainThread only;
  return only;
}

/// Xlib ends the process when its server goes away, with exit code 1 and no word of ours, and does not allow to go on:
/// write what is to be written, say so, and end as a lost device does. The call that failed may be the main thread's or
/// that of a thread that wakes it.
int on_display_lost(void*) {
  constexpr std::chrono::seconds kPatience{5};  // with a frame that is being made
  MainThread& thread = main_thread();
  static std::atomic_flag told;
  while (told.test_and_set()) std::this_thread::sleep_for(kPatience);  // another thread is at it, and ends the process
  const bool here = std::this_thread::get_id() == thread.id;
  std::fputs("error: the connection to the display was lost\n", stderr);
  if (here || thread.busy.try_lock_for(kPatience)) {
    if (const auto say = std::exchange(thread.terminate_handler, nullptr)) say();
  }
  std::fflush(nullptr);
  std::_Exit(static_cast<int>(ErrorKind::device));
}

/// Through the library that GLFW has loaded; without it (Wayland) there is nothing to do.
void watch_display() {
  using Handler = int (*)(void*);
  using Set = Handler (*)(Handler);
  void* x11 = dlopen("libX11.so.6", RTLD_LAZY | RTLD_NOLOAD);
  if (!x11) return;
  if (const auto set = reinterpret_cast<Set>(dlsym(x11, "XSetIOErrorHandler"))) set(&on_display_lost);
  dlclose(x11);
}

DesktopWindow& self(GLFWwindow* window) { return *static_cast<DesktopWindow*>(glfwGetWindowUserPointer(window)); }

}  // namespace

Result<std::unique_ptr<DesktopWindow>> DesktopWindow::create(const std::string& title, Size size, bool exact) {
  if (glfwInit() != GLFW_TRUE) return no_display(glfw_reason());
  std::unique_ptr<DesktopWindow> out(new DesktopWindow);  // from here on its destructor ends GLFW
  main_thread().id = std::this_thread::get_id();
  main_thread().busy.lock();
  watch_display();
  if (glfwVulkanSupported() != GLFW_TRUE) return no_display(glfw_reason());
  glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, exact ? GLFW_FALSE : GLFW_TRUE);
  glfwWindowHintString(GLFW_X11_CLASS_NAME, "afterglow");
  glfwWindowHintString(GLFW_X11_INSTANCE_NAME, "afterglow");
  // No larger than the screen.
  if (GLFWmonitor* monitor = glfwGetPrimaryMonitor()) {
    int x = 0, y = 0, width = 0, height = 0;
    glfwGetMonitorWorkarea(monitor, &x, &y, &width, &height);
    if (width > 0 && height > 0) size = {std::min(size.width, width), std::min(size.height, height)};
  }
  out->window_ = glfwCreateWindow(size.width, size.height, title.c_str(), nullptr, nullptr);
  if (!out->window_) return no_display(glfw_reason());
  glfwSetWindowSizeLimits(out->window_, 480, 320, GLFW_DONT_CARE, GLFW_DONT_CARE);
  out->listen();
  return out;
}

DesktopWindow::~DesktopWindow() {
  if (window_) glfwDestroyWindow(window_);
  glfwTerminate();
  main_thread().terminate_handler = nullptr;
  main_thread().busy.unlock();
}

void DesktopWindow::listen() {
  glfwSetWindowUserPointer(window_, this);
  glfwSetKeyCallback(window_, &on_key);
  glfwSetDropCallback(window_, &on_drop);
  glfwSetWindowCloseCallback(window_, &on_close);
  // What these say is asked for when a frame is drawn; that there was something is enough.
  glfwSetFramebufferSizeCallback(window_, [](GLFWwindow* w, int, int) { self(w).size_changes(); });
  glfwSetWindowRefreshCallback(window_, [](GLFWwindow* w) { self(w).events_.any = self(w).events_.exposed = true; });
  glfwSetWindowIconifyCallback(window_, [](GLFWwindow* w, int) {
    self(w).size_changes();
    self(w).events_.exposed = true;
  });
  glfwSetWindowContentScaleCallback(window_, [](GLFWwindow* w, float, float) { self(w).events_.any = true; });
  glfwSetWindowFocusCallback(window_, &on_focus);
  glfwSetCursorPosCallback(window_, &on_move);
  glfwSetCursorEnterCallback(window_, &on_enter);
  glfwSetMouseButtonCallback(window_, &on_button);
  glfwSetScrollCallback(window_, &on_wheel);
  glfwSetCharCallback(window_, &on_text);
}

void DesktopWindow::take(GLFWwindow* window, const InputEvent& event) {
  WindowEvents& events = self(window).events_;
  events.any = true;
  // Where the pointer has been between two places that follow each other tells nobody anything.
  const bool follows = !events.input.empty() && events.input.back().kind == InputEvent::Kind::move;
  if (event.kind == InputEvent::Kind::move && follows) events.input.pop_back();
  events.input.push_back(event);
  events.input.back().time = glfwGetTime();
}

int key_of_letter(int key, const char* name) {
  if (!name || name[0] == '\0' || name[1] != '\0') return key;
  constexpr std::string_view kSigns = "+=-,.[]/";
  constexpr int kKeys[] = {GLFW_KEY_EQUAL,  GLFW_KEY_EQUAL,        GLFW_KEY_MINUS,         GLFW_KEY_COMMA,
                           GLFW_KEY_PERIOD, GLFW_KEY_LEFT_BRACKET, GLFW_KEY_RIGHT_BRACKET, GLFW_KEY_SLASH};
  if (const std::size_t sign = kSigns.find(name[0]); sign != kSigns.npos) return kKeys[sign];
  const char letter = static_cast<char>(name[0] & ~0x20);  // in capitals
  return letter >= 'A' && letter <= 'Z' ? GLFW_KEY_A + (letter - 'A') : key;
}

void DesktopWindow::on_key(GLFWwindow* window, int key, int scancode, int action, int mods) {
  take(window, {.kind = InputEvent::Kind::key,
                .code = key_of_letter(key, glfwGetKeyName(key, scancode)),
                .physical = key,
                .scancode = scancode,
                .down = action != GLFW_RELEASE,
                .repeat = action == GLFW_REPEAT,
                .mods = mods & 0xf});
}

void DesktopWindow::on_text(GLFWwindow* window, unsigned character) {
  take(window, {.kind = InputEvent::Kind::text, .text = character});
}

void DesktopWindow::on_move(GLFWwindow* window, double x, double y) {
  take(window, {.kind = InputEvent::Kind::move, .x = x, .y = y});
}

void DesktopWindow::on_enter(GLFWwindow* window, int entered) {
  if (!entered) return take(window, {.kind = InputEvent::Kind::leave});
  double x = 0, y = 0;
  glfwGetCursorPos(window, &x, &y);
  on_move(window, x, y);
}

void DesktopWindow::on_button(GLFWwindow* window, int button, int action, int mods) {
  take(window, {.kind = InputEvent::Kind::button, .code = button, .down = action == GLFW_PRESS, .mods = mods & 0xf});
}

void DesktopWindow::on_wheel(GLFWwindow* window, double x, double y) {
  take(window, {.kind = InputEvent::Kind::wheel, .x = x, .y = y});
}

void DesktopWindow::on_focus(GLFWwindow* window, int focused) {
  take(window, {.kind = InputEvent::Kind::focus, .down = focused == GLFW_TRUE});
}

void DesktopWindow::on_drop(GLFWwindow* window, int count, const char** paths) {
  WindowEvents& events = self(window).events_;
  events.any = true;
  for (int i = 0; i < count; ++i) events.dropped.emplace_back(paths[i]);
}

void DesktopWindow::on_close(GLFWwindow* window) { self(window).events_.any = self(window).events_.close = true; }

std::shared_ptr<const Presentation> DesktopWindow::presentation() const {
  auto out = std::make_shared<Presentation>();
  std::uint32_t count = 0;
  const char** names = glfwGetRequiredInstanceExtensions(&count);
  for (std::uint32_t i = 0; i < count; ++i) out->instance_extensions.emplace_back(names[i]);
  out->make_surface = [window = window_](VkInstance instance) -> Result<VkSurfaceKHR> {
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    AFTERGLOW_VK(glfwCreateWindowSurface(instance, window, nullptr, &surface), "cannot show pictures in the window");
    return surface;
  };
  return out;
}

void DesktopWindow::show() { glfwShowWindow(window_); }
void DesktopWindow::move_to(int x, int y) {
  int count = 0;
  GLFWmonitor** monitors = glfwGetMonitors(&count);
  for (int i = 0; i < count; ++i) {
    int left = 0, top = 0, width = 0, height = 0;
    glfwGetMonitorWorkarea(monitors[i], &left, &top, &width, &height);
    if (x >= left && y >= top && x < left + width && y < top + height) return glfwSetWindowPos(window_, x, y);
  }
}

Rect DesktopWindow::place() const {
  if (full_screen_) return windowed_;
  if (glfwGetWindowAttrib(window_, GLFW_ICONIFIED)) return {};
  Rect out;
  glfwGetWindowPos(window_, &out.x, &out.y);
  glfwGetWindowSize(window_, &out.width, &out.height);
  return out;
}

void DesktopWindow::set_title(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }

/// X11 answers each question by a way to the server and back: asked once after each change.
void DesktopWindow::hide() { glfwHideWindow(window_); }

void DesktopWindow::restore() {
  if (!glfwGetWindowAttrib(window_, GLFW_ICONIFIED)) return;
  glfwRestoreWindow(window_);
  glfwRequestWindowAttention(window_);
}

DesktopWindow::Extent DesktopWindow::extent() const {
  if (extent_) return *extent_;
  Extent& out = extent_.emplace();
  if (glfwGetWindowAttrib(window_, GLFW_ICONIFIED)) return out;
  glfwGetWindowSize(window_, &out.window.width, &out.window.height);
  glfwGetFramebufferSize(window_, &out.framebuffer.width, &out.framebuffer.height);
  return out;
}

void DesktopWindow::size_changes() {
  extent_.reset();
  events_.any = true;
}

float DesktopWindow::content_scale() const {
  float x = 1, y = 1;
  glfwGetWindowContentScale(window_, &x, &y);
  return std::clamp(std::max(x, y), 0.5f, 8.0f);
}

void DesktopWindow::set_full_screen(bool on) {
  if (on == full_screen_) return;
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  if (!monitor) return;
  if (on) {
    glfwGetWindowPos(window_, &windowed_.x, &windowed_.y);
    glfwGetWindowSize(window_, &windowed_.width, &windowed_.height);
    const GLFWvidmode* mode = glfwGetVideoMode(monitor);
    glfwSetWindowMonitor(window_, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
  } else {
    glfwSetWindowMonitor(window_, nullptr, windowed_.x, windowed_.y, windowed_.width, windowed_.height, 0);
  }
  full_screen_ = on;
  size_changes();
}

void DesktopWindow::set_clipboard(const std::string& text) { glfwSetClipboardString(window_, text.c_str()); }

void DesktopWindow::set_last_words(std::function<void()> say) { main_thread().terminate_handler = std::move(say); }

void DesktopWindow::wait(double seconds) {
  if (seconds <= 0) {
    glfwPollEvents();
    return;
  }
  main_thread().busy.unlock();
  if (std::isfinite(seconds)) {
    glfwWaitEventsTimeout(seconds);
  } else {
    glfwWaitEvents();
  }
  main_thread().busy.lock();
}

WindowEvents DesktopWindow::take_events() { return std::exchange(events_, {}); }
void DesktopWindow::wake() { glfwPostEmptyEvent(); }

}  // namespace afterglow
