// SPDX-License-Identifier: MIT
// The interface without a window: frames of Dear ImGui with a pointer and keys that are moved by hand, on a real
// preset.
#pragma once

#include <gtest/gtest.h>
#include <imgui_internal.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "window/interface.h"
#include "window/panel.h"

namespace afterglow::test {

namespace fs = std::filesystem;

inline constexpr const char* kPreset =
    "local fx = require \"afterglow\"\n"
    "return fx.stack {\n"
    "  name = \"Test look\",\n"
    "  fx.bloom { intensity = 0.2 },  -- glow\n"
    "  fx.tone_mapping { mode = \"aces\" },\n"
    "  fx.color_adjustments { contrast = 5 + 5, post_exposure = fx.curve { { 1, 0 }, { 9, 1 } } },\n"
    "}\n";

/// A preset and plain data in place of a player.
class Port : public PanelPort {
 public:
  explicit Port(const fs::path& file) : file_(file) { reload(); }
  void reload() {
    build_.reset();
    preset_.reset();
    shaders_ = std::make_unique<ShaderLibrary>(search_path_for(file_, {}));
    PresetOptions options;
    if (changes.stack_text()) options.text = *changes.stack_text();
    auto loaded = Preset::load(file_, options, *shaders_, diagnostics_);
    ASSERT_TRUE(loaded) << loaded.error().text();
    preset_ = std::make_unique<Preset>(std::move(*loaded));
    auto build = preset_->evaluate({.size = {64, 32}}, diagnostics_);
    ASSERT_TRUE(build) << build.error().text();
    build_ = std::move(*build);
    ++now.generation;
  }

  const Preset* preset() override { return preset_.get(); }
  const Build* build() override { return build_ ? &*build_ : nullptr; }
  LiveStatus status() override { return now; }
  const std::vector<Skipped>& skipped() override { return skips; }
  std::vector<KernelTime> times() override { return frame_times.kernels; }
  const SettingEdits& edits() override { return changes; }
  void set(const std::string& entry, const std::string& setting, const SettingValue& value) override {
    ++sets;
    changes.set(entry, setting, value);
  }
  void reset(const std::string& entry, const std::string& setting) override { changes.reset(entry, setting); }
  void reset_all() override { changes.reset_all(); }
  bool undo() override { return changes.undo(); }
  void take_back() override { changes.take_back(); }
  bool redo() override { return changes.redo(); }
  void end_gesture() override { changes.end_gesture(); }
  void rebase(const std::vector<BaseChange>& base) override { changes.rebase(base); }
  void rebase(const std::vector<BaseChange>& base, const TextChange& text) override { changes.rebase(base, text); }
  void set_all(const std::vector<SettingEdit>& values) override { changes.set_all(values); }
  void set_stack(const StackChange& change) override { changes.set_stack(change); }
  void reset_stack() override { changes.reset_stack(); }
  View& view() override { return look; }
  Rect middle_region() override { return {10, 20, 30, 40}; }
  std::vector<std::string> images() override { return {"source", "bloom.down[1]", "bloom.up[1]"}; }
  std::string shown_image() override { return image; }
  void show(const std::string& name) override { image = name; }
  bool has_other() override { return false; }

  SettingEdits changes;
  LiveStatus now;
  std::vector<Skipped> skips;
  FrameTimes frame_times;
  View look;
  std::string image;
  int sets = 0;

 private:
  fs::path file_;
  Diagnostics diagnostics_;
  std::unique_ptr<ShaderLibrary> shaders_;
  std::unique_ptr<Preset> preset_;
  std::optional<Build> build_;
};

/// Dear ImGui is told of modifiers by events from version 1.89 on.
#if IMGUI_VERSION_NUM >= 18900
inline void hold_shift(bool down) { ImGui::GetIO().AddKeyEvent(ImGuiMod_Shift, down); }
inline void hold_control(bool down) { ImGui::GetIO().AddKeyEvent(ImGuiMod_Ctrl, down); }
#else
inline void hold_shift(bool down) {
  ImGui::GetIO().KeyShift = down;
  ImGui::GetIO().KeyMods = down ? ImGuiKeyModFlags_Shift : 0;
}
inline void hold_control(bool down) {
  ImGui::GetIO().KeyCtrl = down;
  ImGui::GetIO().KeyMods = down ? ImGuiKeyModFlags_Ctrl : 0;
}
#endif

class PanelTest : public ::testing::Test {
 protected:
  PanelTest()
      : folder_(fs::temp_directory_path() / ("afterglow_panel_" + std::to_string(getpid()))),
        file(folder_ / "look.lua"),
        interface(nullptr) {
    fs::create_directories(folder_);
    std::ofstream(file) << kPreset;
    port = std::make_unique<Port>(file);
    panel = std::make_unique<Panel>(file, PresetOptions{});
    what_ = [this] { panel->draw(interface.ui(), *port, {0, 0}, {kWidth, kHeight}); };
    move(-100, -100);
    frame();
  }
  ~PanelTest() override {
    std::error_code ec;
    fs::remove_all(folder_, ec);
  }

  void frame() {
    interface.begin({static_cast<int>(2 * kWidth), static_cast<int>(kHeight)});
    what_();
    interface.end();
  }
  /// Does that to the chosen entry, and takes what comes of it.
  void change_stack(Panel::EntryAction action) {
    panel->act(interface.ui(), *port, action);
    frame();
    panel->stack().wait();
    frame();
  }
  /// What the first window of a frame says in words.
  std::string words() {
    move(-100, -100);  // tooltips are windows too
    frame();
    ImGui::SetClipboardText("");
    interface.begin({static_cast<int>(2 * kWidth), static_cast<int>(kHeight)});
    ImGui::LogToClipboard();
    what_();
    interface.end();
    const char* text = ImGui::GetClipboardText();
    return text ? text : "";
  }

  void press_key(int code) {
#if IMGUI_VERSION_NUM >= 18700
    ImGui::GetIO().AddKeyEvent(static_cast<ImGuiKey>(code), true);
    frame();
    ImGui::GetIO().AddKeyEvent(static_cast<ImGuiKey>(code), false);
#else
    ImGui::GetIO().KeyMap[code] = code;
    ImGui::GetIO().KeysDown[code] = true;
    frame();
    ImGui::GetIO().KeysDown[code] = false;
#endif
    frame();
  }
  void move(float x, float y) { ImGui::GetIO().MousePos = {x, y}; }
  /// The panel makes bloom's intensity 0.5, and then the file 0.9; returns what the file holds.
  std::string change_both() {
    port->changes.set("bloom", "intensity", {SettingType::number, {0.5}, ""});
    frame();
    std::string text = kPreset;
    text.replace(text.find("0.2"), 3, "0.9");
    std::ofstream(file) << text;
    port->reload();
    return text;
  }
  void press(bool down, int button = 0) {
    ImGui::GetIO().MouseDown[button] = down;
    frame();
  }
  void click(int button = 0) {
    frame();
    press(true, button);
    press(false, button);
    frame();
  }
  static ImGuiID id_of(const std::vector<std::string>& path) {
    ImGuiID id = 0;
    for (const auto& part : path) id = ImHashStr(part.c_str(), 0, id);
    return id;
  }
  /// Moves the pointer until it is over the item; false when it is nowhere.
  bool find(const std::vector<std::string>& path) {
    const ImGuiID id = id_of(path);
    std::vector<float> columns{20, 45, 80, 100, 130, 170, 250};
    for (float x = 8; x < kWidth; x += 8) columns.push_back(x);
    for (const float x : columns)
      for (float y = 4; y < kHeight; y += 6) {
        move(x, y);
        frame();
        if (ImGui::GetCurrentContext()->HoveredId == id) return true;
      }
    return false;
  }
  /// The button in the box at the panel's end.
  bool find_in_outcome(const std::string& label) {
    for (float y = kHeight - 8; y > kHeight - 200; y -= 6)
      for (float x = 16; x < kWidth; x += 8) {
        move(x, y);
        frame();
        const ImGuiWindow* window = ImGui::GetCurrentContext()->HoveredWindow;
        if (window && std::string(window->Name).starts_with("Settings/outcome") &&
            ImGui::GetCurrentContext()->HoveredId == ImHashStr(label.c_str(), 0, window->ID))
          return true;
      }
    return false;
  }
  /// The button of the Save as dialog, which stands in the middle.
  bool find_in_dialog() {
    const ImGuiID id = id_of({"Save preset as###name", "###do"});
    for (float y = kHeight / 2 - 120; y < kHeight / 2 + 120; y += 6)
      for (float x = kWidth - 260; x < kWidth + 260; x += 12) {
        move(x, y);
        frame();
        if (ImGui::GetCurrentContext()->HoveredId == id) return true;
      }
    return false;
  }
  SettingValue edited(const std::string& entry, const std::string& setting) {
    return port->changes.value(entry, setting).value_or(SettingValue{SettingType::vec3, {-99, -99, -99}, ""});
  }

  static constexpr float kWidth = 440, kHeight = 1900;
  fs::path folder_;
  fs::path file;
  Interface interface;
  std::unique_ptr<Port> port;
  std::unique_ptr<Panel> panel;
  std::function<void()> what_;
};

}  // namespace afterglow::test
