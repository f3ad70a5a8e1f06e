// SPDX-License-Identifier: MIT
#include "window/interface.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <filesystem>

#include "window/theme.h"

namespace afterglow {
namespace fs = std::filesystem;

namespace {

const ImVec2 kElsewhere(-FLT_MAX, -FLT_MAX);  // as Dear ImGui has it
constexpr float kBodySize = 15, kMonoSize = 13.5f;

/// Debian's, Fedora's and Arch's places. Without any of them ImGui's own bitmap font serves.
std::string find_font(const char* name) {
  for (const char* folder : {"/usr/share/fonts/truetype/dejavu", "/usr/share/fonts/dejavu-sans-fonts",
                             "/usr/share/fonts/dejavu-sans-mono-fonts", "/usr/share/fonts/TTF"}) {
    const fs::path file = fs::path(folder) / name;
    std::error_code ec;
    if (fs::is_regular_file(file, ec)) return file.string();
  }
  return {};
}

/// Latin, and the signs that the interface draws: arrows, dashes, degrees, media keys.
/// Latin with the letters of Vietnamese and Romanian, Greek, Cyrillic, signs.
constexpr ImWchar kGlyphs[] = {0x0020, 0x017f, 0x01a0, 0x01b0, 0x0218, 0x021b, 0x0300, 0x0309, 0x0323, 0x0323,
                               0x0370, 0x03ff, 0x0400, 0x045f, 0x0490, 0x0491, 0x1ea0, 0x1ef9, 0x2010, 0x2027,
                               0x2030, 0x203a, 0x2070, 0x209f, 0x2190, 0x21ff, 0x2200, 0x22ff, 0x2300, 0x23ff,
                               0x2500, 0x25ff, 0x2600, 0x26ff, 0x2700, 0x27bf, 0};

ImFont* add_font(const char* name, float size) {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  ImFontConfig config;
  config.OversampleH = 2;
  config.OversampleV = 1;
  if (const std::string file = find_font(name); !file.empty()) {
    if (ImFont* font = atlas.AddFontFromFileTTF(file.c_str(), std::round(size), &config, kGlyphs)) return font;
  }
  config.SizePixels = std::round(size * 13 / kBodySize);
  return atlas.AddFontDefault(&config);
}

/// In Dear ImGui 1.86 Enter opens fields and does no more; in later ones, which have no such member, it presses buttons
/// too.
template <typename Context>
void press_by_enter(Context& context) {
  if constexpr (requires { context.NavActivateInputId; }) {
    if (context.NavActivateInputId != 0)
      context.NavActivateId = context.NavActivateDownId = context.NavActivatePressedId = context.NavActivateInputId;
  }
}

#if IMGUI_VERSION_NUM >= 18900

/// Keys that fields, lists and navigation know, and modifiers by themselves.
ImGuiKey imgui_key(int key) {
  struct Range {
    int first, last;  // of GLFW
    ImGuiKey begin;
  };
  static constexpr Range kRanges[] = {{GLFW_KEY_A, GLFW_KEY_Z, ImGuiKey_A},
                                      {GLFW_KEY_0, GLFW_KEY_9, ImGuiKey_0},
                                      {GLFW_KEY_KP_0, GLFW_KEY_KP_9, ImGuiKey_Keypad0},
                                      {GLFW_KEY_F1, GLFW_KEY_F12, ImGuiKey_F1}};
  for (const auto& range : kRanges)
    if (key >= range.first && key <= range.last) return static_cast<ImGuiKey>(range.begin + (key - range.first));
  switch (key) {
    case GLFW_KEY_TAB:
      return ImGuiKey_Tab;
    case GLFW_KEY_LEFT:
      return ImGuiKey_LeftArrow;
    case GLFW_KEY_RIGHT:
      return ImGuiKey_RightArrow;
    case GLFW_KEY_UP:
      return ImGuiKey_UpArrow;
    case GLFW_KEY_DOWN:
      return ImGuiKey_DownArrow;
    case GLFW_KEY_PAGE_UP:
      return ImGuiKey_PageUp;
    case GLFW_KEY_PAGE_DOWN:
      return ImGuiKey_PageDown;
    case GLFW_KEY_HOME:
      return ImGuiKey_Home;
    case GLFW_KEY_END:
      return ImGuiKey_End;
    case GLFW_KEY_INSERT:
      return ImGuiKey_Insert;
    case GLFW_KEY_DELETE:
      return ImGuiKey_Delete;
    case GLFW_KEY_BACKSPACE:
      return ImGuiKey_Backspace;
    case GLFW_KEY_SPACE:
      return ImGuiKey_Space;
    case GLFW_KEY_ENTER:
      return ImGuiKey_Enter;
    case GLFW_KEY_KP_ENTER:
      return ImGuiKey_KeypadEnter;
    case GLFW_KEY_ESCAPE:
      return ImGuiKey_Escape;
    case GLFW_KEY_LEFT_CONTROL:
      return ImGuiKey_LeftCtrl;
    case GLFW_KEY_RIGHT_CONTROL:
      return ImGuiKey_RightCtrl;
    case GLFW_KEY_LEFT_SHIFT:
      return ImGuiKey_LeftShift;
    case GLFW_KEY_RIGHT_SHIFT:
      return ImGuiKey_RightShift;
    case GLFW_KEY_LEFT_ALT:
      return ImGuiKey_LeftAlt;
    case GLFW_KEY_RIGHT_ALT:
      return ImGuiKey_RightAlt;
    case GLFW_KEY_LEFT_SUPER:
      return ImGuiKey_LeftSuper;
    case GLFW_KEY_RIGHT_SUPER:
      return ImGuiKey_RightSuper;
    default:
      return ImGuiKey_None;
  }
}

/// The backend asks the window which modifiers are held: now, and not when the key went down.
void feed_key(GLFWwindow*, const InputEvent& event) {
  ImGuiIO& io = ImGui::GetIO();
  struct Modifier {
    int bit, left, right;
    ImGuiKey key;
  };
  static constexpr Modifier kModifiers[] = {
      {GLFW_MOD_CONTROL, GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL, static_cast<ImGuiKey>(ImGuiMod_Ctrl)},
      {GLFW_MOD_SHIFT, GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT, static_cast<ImGuiKey>(ImGuiMod_Shift)},
      {GLFW_MOD_ALT, GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT, static_cast<ImGuiKey>(ImGuiMod_Alt)},
      {GLFW_MOD_SUPER, GLFW_KEY_LEFT_SUPER, GLFW_KEY_RIGHT_SUPER, static_cast<ImGuiKey>(ImGuiMod_Super)}};
  for (const auto& modifier : kModifiers) {
    const bool itself = event.code == modifier.left || event.code == modifier.right;
    io.AddKeyEvent(modifier.key, itself ? event.down : (event.mods & modifier.bit) != 0);
  }
  if (!event.repeat) io.AddKeyEvent(imgui_key(event.code), event.down);
}

#else

void feed_key(GLFWwindow* window, const InputEvent& event) {
  const int key = IMGUI_VERSION_NUM >= 18700 ? event.physical : event.code;  // it looks the letter up itself, or not
  ImGui_ImplGlfw_KeyCallback(window, key, event.scancode,
                             event.repeat ? GLFW_REPEAT
                             : event.down ? GLFW_PRESS
                                          : GLFW_RELEASE,
                             event.mods);
}

#endif

}  // namespace

Interface::Interface(GLFWwindow* window) : pointer_(kElsewhere) {
  IMGUI_CHECKVERSION();
  context_ = ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // nothing is left behind in the folder of the call
  io.LogFilename = nullptr;
  io.ConfigWindowsMoveFromTitleBarOnly = true;
  io.ConfigWindowsResizeFromEdges = false;
#if IMGUI_VERSION_NUM >= 18700
  io.ConfigInputTrickleEventQueue = false;  // InputQueue spreads events over frames
#endif
  io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
  if (window && ImGui_ImplGlfw_InitForVulkan(window, false)) {
    window_ = window;
    shapes_[ImGuiMouseCursor_TextInput] = glfwCreateStandardCursor(GLFW_IBEAM_CURSOR);
    shapes_[ImGuiMouseCursor_ResizeNS] = glfwCreateStandardCursor(GLFW_VRESIZE_CURSOR);
    shapes_[ImGuiMouseCursor_ResizeEW] = glfwCreateStandardCursor(GLFW_HRESIZE_CURSOR);
    shapes_[ImGuiMouseCursor_Hand] = glfwCreateStandardCursor(GLFW_HAND_CURSOR);
  }
  set_scale(1);
}

Interface::~Interface() {
  for (GLFWcursor* shape : shapes_)
    if (shape) glfwDestroyCursor(shape);
  if (window_) ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext(context_);
}

bool Interface::set_scale(float scale) {
  if (ui_.body && std::abs(scale - ui_.scale) < 1e-3f) return false;
  ui_.scale = scale;
  apply_theme(scale);
  load_fonts();
  return true;
}

void Interface::load_fonts() {
  ImGuiIO& io = ImGui::GetIO();
  io.Fonts->Clear();
  ui_.body = add_font("DejaVuSans.ttf", kBodySize * ui_.scale);
  ui_.bold = add_font("DejaVuSans-Bold.ttf", kBodySize * ui_.scale);
  ui_.mono = add_font("DejaVuSansMono.ttf", kMonoSize * ui_.scale);
  io.FontDefault = ui_.body;
  ui_.cells.reserve(*io.Fonts);
  io.Fonts->Build();
}

void Interface::feed(const InputEvent& event) {
  using Kind = InputEvent::Kind;
  switch (event.kind) {
    case Kind::move:
      pointer_ = {static_cast<float>(event.x), static_cast<float>(event.y)};
      break;
    case Kind::leave:
      pointer_ = kElsewhere;
      break;
    case Kind::button:
      if (event.code >= 0 && event.code < static_cast<int>(buttons_.size()))
        buttons_[static_cast<std::size_t>(event.code)] = event.down;
      if (event.down) note_press(event);
      break;
    case Kind::wheel:
      ImGui_ImplGlfw_ScrollCallback(window_, event.x, event.y);
      break;
    case Kind::key:
      feed_key(window_, event);
      break;
    case Kind::text:
      ImGui_ImplGlfw_CharCallback(window_, event.text);
      break;
    case Kind::focus:
      if (!event.down) buttons_.fill(false);
      ImGui_ImplGlfw_WindowFocusCallback(window_, event.down ? GLFW_TRUE : GLFW_FALSE);
      break;
  }
}

/// Two presses are one double click by their own times: frames may be further apart than they are.
void Interface::note_press(const InputEvent& event) {
  constexpr double kApart = 0.4;  // seconds
  constexpr float kAside = 6;     // pixels of a plain display
  const bool here = std::abs(pointer_.x - pressed_at_.x) + std::abs(pointer_.y - pressed_at_.y) < ui_.px(kAside);
  twice_ = !twice_ && here && pressed_.down && pressed_.code == event.code && event.time - pressed_.time < kApart;
  pressed_ = event;
  pressed_at_ = pointer_;
}

/// In place of what the backend asks the window: that is what holds now and not when it happened, and each question is
/// a way to the display and back.
void Interface::take_pointer() {
  ImGuiIO& io = ImGui::GetIO();
  io.MouseDoubleClickTime = twice_ ? FLT_MAX : 0;
#if IMGUI_VERSION_NUM >= 18700
  io.AddMousePosEvent(pointer_.x, pointer_.y);
  for (std::size_t i = 0; i < buttons_.size(); ++i) io.AddMouseButtonEvent(static_cast<int>(i), buttons_[i]);
#else
  io.MousePos = pointer_;
  for (std::size_t i = 0; i < buttons_.size(); ++i) io.MouseDown[i] = buttons_[i];
#endif
}

void Interface::show_pointer() {
  const ImGuiMouseCursor wanted = ImGui::GetMouseCursor();
  GLFWcursor* shape = wanted >= 0 ? shapes_[static_cast<std::size_t>(wanted)] : nullptr;
  if (shape != shape_) glfwSetCursor(window_, shape);
  shape_ = shape;
}

void Interface::begin(Size size, Size framebuffer) {
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {static_cast<float>(size.width), static_cast<float>(size.height)};
  if (size.area() > 0)
    io.DisplayFramebufferScale = {static_cast<float>(framebuffer.width) / io.DisplaySize.x,
                                  static_cast<float>(framebuffer.height) / io.DisplaySize.y};
  constexpr double kUsual = 1.0 / 60, kLeast = 1e-6;  // seconds; Dear ImGui takes no 0
  io.DeltaTime = static_cast<float>(kUsual);
  if (window_) {
    const double now = glfwGetTime();
    if (began_ > 0) io.DeltaTime = static_cast<float>(std::max(now - began_, kLeast));
    began_ = now;
    take_pointer();
  } else {
    io.Fonts->SetTexID(nullptr);
  }
  ImGui::NewFrame();
  press_by_enter(*ImGui::GetCurrentContext());
}

const ImDrawData& Interface::end() {
  ImGui::Render();
  if (window_) show_pointer();
  return *ImGui::GetDrawData();
}

void Interface::navigate(const char* name) {
  ImGuiIO& io = ImGui::GetIO();
  ImGuiContext& context = *ImGui::GetCurrentContext();
  ImGuiWindow* window = *name ? ImGui::FindWindowByName(name) : nullptr;
  ImGui::FocusWindow(window);
  if (!window) {
    io.ConfigFlags &= ~ImGuiConfigFlags_NavEnableKeyboard;
    context.NavId = 0;
    return;
  }
  io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
  ImGui::NavInitWindow(window, true);
#if IMGUI_VERSION_NUM >= 19140
  context.NavCursorVisible = context.NavHighlightItemUnderNav = true;
#else
  context.NavDisableHighlight = false;
  context.NavDisableMouseHover = true;
#endif
}

bool Interface::holds_something() const {
  const ImGuiContext& context = *ImGui::GetCurrentContext();
  return context.ActiveId != 0 || !context.OpenPopupStack.empty();
}

bool Interface::close_popups() {
  if (ImGui::GetCurrentContext()->OpenPopupStack.empty()) return false;
  ImGui::ClosePopupToLevel(0, true);
  return true;
}

bool Interface::wants_keyboard() const {
  // Both stay for a frame behind a field that was left.
  const ImGuiContext& context = *ImGui::GetCurrentContext();
  return context.ActiveId != 0 && (context.IO.WantTextInput || context.WantTextInputNextFrame == 1);
}
bool Interface::wants_mouse() const { return ImGui::GetIO().WantCaptureMouse; }

}  // namespace afterglow
