// SPDX-License-Identifier: MIT
#include "window/interface.h"

#include <backends/imgui_impl_glfw.h>

#include <cmath>
#include <filesystem>

#include "window/theme.h"

namespace afterglow {
namespace fs = std::filesystem;

namespace {

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
constexpr ImWchar kGlyphs[] = {0x0020, 0x017f, 0x0370, 0x03ff, 0x2010, 0x2027, 0x2030, 0x203a,
                               0x2070, 0x209f, 0x2190, 0x21ff, 0x2200, 0x22ff, 0x2300, 0x23ff,
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

}  // namespace

Interface::Interface(GLFWwindow* window) {
  IMGUI_CHECKVERSION();
  context_ = ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // nothing is left behind in the folder of the call
  io.LogFilename = nullptr;
  io.ConfigWindowsMoveFromTitleBarOnly = true;
  io.ConfigWindowsResizeFromEdges = false;
  io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
  if (window) has_window_ = ImGui_ImplGlfw_InitForVulkan(window, true);
  set_scale(1);
}

Interface::~Interface() {
  if (has_window_) ImGui_ImplGlfw_Shutdown();
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
  io.Fonts->Build();
}

void Interface::note_press(int key) { pressed_.push_back(key); }

// From version 1.87 on Dear ImGui keeps presses in a queue of its own.
#if IMGUI_VERSION_NUM < 18700
void Interface::hold_pressed() {
  auto& down = ImGui::GetIO().KeysDown;
  for (const int key : pressed_) {
    if (key < 0 || key >= IM_ARRAYSIZE(ImGui::GetIO().KeysDown) || down[key]) continue;
    down[key] = true;
    held_.push_back(key);
  }
  pressed_.clear();
}

void Interface::release_held() {
  for (const int key : held_) ImGui::GetIO().KeysDown[key] = false;
  held_.clear();
}
#else
void Interface::hold_pressed() { pressed_.clear(); }
void Interface::release_held() {}
#endif

void Interface::begin(Size size, float seconds) {
  hold_pressed();
  if (has_window_) {
    ImGui_ImplGlfw_NewFrame();
  } else {
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {static_cast<float>(size.width), static_cast<float>(size.height)};
    io.DeltaTime = seconds;
    io.Fonts->SetTexID(nullptr);
  }
  ImGui::NewFrame();
}

const ImDrawData& Interface::end() {
  ImGui::Render();
  release_held();
  return *ImGui::GetDrawData();
}

bool Interface::wants_keyboard() const { return ImGui::GetIO().WantTextInput; }
bool Interface::wants_mouse() const { return ImGui::GetIO().WantCaptureMouse; }

}  // namespace afterglow
