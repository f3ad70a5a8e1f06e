// SPDX-License-Identifier: MIT
// Words of the interface can be read: each one's contrast to what lies under it is computed from what is drawn, in
// every part of the window, over dark, grey and white pictures, with the pointer everywhere.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "core/file.h"
#include "image/writer.h"
#include "text_contrast.h"
#include "window/interface.h"
#include "window/overlay.h"
#include "window/play_parts.h"
#include "window/quit_dialog.h"
#include "window/theme.h"

namespace afterglow::test {
namespace {

namespace fs = std::filesystem;

constexpr double kLeast = 4.5;         // WCAG 2, level AA
constexpr double kLeastResting = 2.5;  // of what cannot be used for now, for which WCAG has no bound
constexpr Rgb kGrounds[] = {{0, 0, 0}, {0.5, 0.5, 0.5}, {1, 1, 1}};

class Contrast : public ::testing::Test {
 protected:
  Contrast() : interface_(nullptr) {
    folder_ = fs::temp_directory_path() / ("afterglow_contrast" + std::to_string(getpid()));
    fs::create_directories(folder_);
    std::ofstream(folder_ / "look.lua")
        << "local fx = require \"afterglow\"\nreturn fx.stack {\n  name = \"Test look\",\n"
           "  fx.bloom { intensity = 0.2 },\n  fx.tone_mapping { mode = \"aces\" },\n"
           "  fx.color_adjustments { contrast = 5 + 5, post_exposure = fx.curve { { 1, 0 }, { 9, 1 } } },\n"
           "  fx.outline { enabled = false },\n}\n";
    for (const int number : {1, 2, 4, 5}) {
      Picture picture;
      picture.color = Image(32, 18, 4);
      picture.color.pixels.assign(picture.color.pixels.size(), 1);
      picture.data_window = picture.display_window = {0, 0, 32, 18};
      Diagnostics none;
      EXPECT_TRUE(write_picture(picture, folder_ / ("s." + std::to_string(number) + ".exr"), {}, none));
    }
    fs::resize_file(folder_ / "s.5.exr", fs::file_size(folder_ / "s.5.exr") / 2);
    device_ = Device::create({.device = "auto"}, diagnostics_).value();
    open({"s.#.exr"});
  }
  void open(const std::vector<std::string>& inputs) {
    parts_.reset();
    PlayerOptions options;
    options.preset = folder_ / "look.lua";
    for (const auto& input : inputs) options.footage.inputs.push_back((folder_ / input).string());
    options.live.follow = false;
    player_ = Player::open(*device_, options, diagnostics_).value();
    turn();
    parts_ =
        std::make_unique<PlayParts>(*player_, ExportSetup{options.preset, {}, options.live.stack, {}}, diagnostics_);
    parts_->add_to(window_);
  }
  ~Contrast() override {
    parts_.reset();
    player_.reset();
    device_.reset();
    std::error_code ec;
    fs::remove_all(folder_, ec);
  }

  void turn() {
    player_->settle();
    ASSERT_TRUE(player_->step());
  }
  Ui& ui() { return interface_.ui(); }

  /// One frame of all parts.
  const ImDrawData& frame() {
    const float w = static_cast<float>(kWidth), h = static_cast<float>(kHeight), panel = 376, bar = 120;
    ui().now += 0.1;
    ui().hover.begin_frame();
    interface_.begin({kWidth, kHeight});
    window_.panel(*player_, ui(), {w - panel, 0}, {panel, h});
    window_.transport(*player_, ui(), {0, h - bar}, {w - panel, bar});
    const OverlayArea area{{0, 0}, {w - panel, h - bar}};
    draw_state_overlay(*player_, ui(), area);
    draw_stats_overlay(*player_, ui(), area);
    draw_scopes_overlay(found_, player_->view(), ui(), area);
    draw_error_overlay(*player_, ui(), area);
    draw_probe_overlay(probe_, player_->view(), ui(), area);
    draw_frame_mark(*player_, ui(), {.place = {}, .picture = {}, .window = {}}, area);
    draw_message_overlay(ui(), area);
    window_.dialogs(*player_, ui());
    if (asks_) (void)draw_quit_dialog(ui(), {"closing", "2 settings of look.lua", "frame 3 of 12 to out.mp4"}, {w, h});
    window_.help(*player_, ui(), {0, 0}, {w, h});
    return interface_.end();
  }
  void move(float x, float y) {
    ImGuiIO& io = ImGui::GetIO();
#if IMGUI_VERSION_NUM >= 18700
    io.AddMousePosEvent(x, y);
#else
    io.MousePos = {x, y};
#endif
  }
  /// Frames until what was asked for stands; then the words are measured, of each pair of colours the first.
  void expect_readable(const std::string& what) {
    faint_.clear();
    move(-100, -100);
    for (int i = 0; i < 8; ++i) frame();
    for (const Rgb& ground : kGrounds) measure(ground);
    // Under the pointer colours are others, and words come up beside it.
    for (float y = 10; y < kHeight; y += 79)
      for (const float x : {60.0f, 560.0f, 940.0f, 1250.0f}) {
        move(x, y);
        frame();
        measure(kGrounds[0]);
      }
    move(-100, -100);
    for (const auto& [pair, words] : faint_) ADD_FAILURE() << what << ": " << words;
  }
  void measure(const Rgb& ground) {
    const TextContrast words(frame(), ground);
    EXPECT_GT(words.glyphs(), 100u) << "there are words";
    for (const FaintText& faint : words.fainter_than(kLeast, kLeastResting))
      faint_.try_emplace({faint.text, faint.ground}, faint.words());
  }
  std::map<std::pair<Rgb, Rgb>, std::string> faint_;

  static constexpr int kWidth = 1280, kHeight = 800;
  fs::path folder_;
  Diagnostics diagnostics_;
  Interface interface_;
  std::unique_ptr<Device> device_;
  std::unique_ptr<Player> player_;
  WindowOptions window_;
  std::unique_ptr<PlayParts> parts_;
  ShownScopes found_;
  Probe probe_{.pixel = {3, 4}, .source = {0.1f, 0.2f, 0.3f, 1}, .result = {1, 2, 3, 1}, .other = {}};
  bool asks_ = false;
};

TEST_F(Contrast, OfThePanelAndTheBar) { expect_readable("as it opens"); }

TEST_F(Contrast, OfWhatWasChangedAndSearched) {
  player_->set("bloom", "intensity", {SettingType::number, {0.7}, ""});
  turn();
  player_->transport().set_range(1, 3, player_->now());
  ui().show_stats = true;
  ui().say("something was written");
  player_->view().exposure = 1;
  player_->view().channel = ViewChannel::red;
  expect_readable("changed");
}

/// Labels of clips lie on the timeline: within the range, beyond it, on frames that cannot be read.
TEST_F(Contrast, OfClipsInARow) {
  open({"s.#.exr", "s.1.exr", "s.#.exr"});
  for (const int first : {0, 3}) {
    player_->transport().set_range(first, 7, player_->now());
    expect_readable("clips");
  }
}

TEST_F(Contrast, OfErrorsAndMissingFrames) {
  player_->transport().go_to(2, player_->now());
  turn();
  expect_readable("a frame is missing");
  player_->transport().go_to(4, player_->now());
  turn();
  expect_readable("a frame cannot be read");
  std::ofstream(folder_ / "look.lua") << "local fx = require \"afterglow\"\nreturn fx.stack {\n  fx.blom {},\n}\n";
  player_->live().reload();
  turn();
  expect_readable("the preset is wrong, and settings rest");
}

TEST_F(Contrast, OfScopesAndMarks) {
  View& view = player_->view();
  view.marks = Marks::stops;
  view.region = Rect{2, 2, 8, 8};
  for (const ScopeScale scale : {ScopeScale::code, ScopeScale::linear, ScopeScale::stops}) {
    view.scope = ScopeKind::all;
    view.scope_scale = scale;
    found_.scopes = player_->scopes({.scale = scale}).value();
    found_.means = player_->means(*view.region).value();
    expect_readable("scopes");
  }
  view.marks = Marks::range;
  expect_readable("marks");
}

TEST_F(Contrast, OfDialogs) {
  window_.browse_presets(*player_, ui());
  expect_readable("the list of presets");
  window_.close_windows();
  window_.edit_stack(*player_, ui(), Action::add_effect);
  expect_readable("the list of effects");
  window_.close_windows();
  window_.edit_stack(*player_, ui(), Action::save_as);
  expect_readable("save as");
  window_.close_windows();
  window_.export_range(*player_, ui());
  expect_readable("export");
  window_.close_windows();
  asks_ = true;
  expect_readable("save before closing?");
  asks_ = false;
  ui().show_help = true;
  expect_readable("all keys");
}

/// What a frame shows of a state that lasts while a button is held: words on all that the theme draws under words.
TEST_F(Contrast, OfEveryPairOfTheTheme) {
  const ImVec4* colors = ImGui::GetStyle().Colors;
  const auto rgb = [](const ImVec4& c) { return Rgb{c.x, c.y, c.z}; };
  const auto over = [&](const ImVec4& top, const Rgb& below) {
    Rgb out;
    const Rgb own = rgb(top);
    for (std::size_t c = 0; c < 3; ++c) out[c] = own[c] * top.w + below[c] * (1 - top.w);
    return out;
  };
  const Rgb base = rgb(colors[ImGuiCol_WindowBg]);
  const ImGuiCol under_words[] = {
      ImGuiCol_WindowBg,      ImGuiCol_PopupBg,          ImGuiCol_FrameBg,       ImGuiCol_FrameBgHovered,
      ImGuiCol_FrameBgActive, ImGuiCol_TitleBg,          ImGuiCol_TitleBgActive, ImGuiCol_MenuBarBg,
      ImGuiCol_SliderGrab,    ImGuiCol_SliderGrabActive, ImGuiCol_Button,        ImGuiCol_ButtonHovered,
      ImGuiCol_ButtonActive,  ImGuiCol_Header,           ImGuiCol_HeaderHovered, ImGuiCol_HeaderActive,
      ImGuiCol_Tab,           ImGuiCol_TabHovered,       ImGuiCol_TabActive,     ImGuiCol_PlotHistogram,
      ImGuiCol_TableHeaderBg, ImGuiCol_TextSelectedBg};
  for (const ImGuiCol ground : under_words)
    EXPECT_GE(contrast(rgb(colors[ImGuiCol_Text]), over(colors[ground], base)), kLeast)
        << ImGui::GetStyleColorName(ground);
  // Dim and coloured words stand on windows, heads of effects, sheets over any picture, and fields.
  const ImU32 words[] = {ui_color::kText,  ui_color::kDim,     ui_color::kAccent,
                         ui_color::kError, ui_color::kWarning, ui_color::kGood};
  for (const ImU32 word : words) {
    const Rgb text = rgb(ImGui::ColorConvertU32ToFloat4(word));
    for (const ImGuiCol ground : {ImGuiCol_WindowBg, ImGuiCol_PopupBg, ImGuiCol_FrameBg, ImGuiCol_Header,
                                  ImGuiCol_HeaderHovered, ImGuiCol_HeaderActive, ImGuiCol_TitleBg})
      EXPECT_GE(contrast(text, over(colors[ground], base)), kLeast)
          << fmt::format("{:08x}", word) << " on " << ImGui::GetStyleColorName(ground);
    for (const Rgb& picture : kGrounds)
      EXPECT_GE(contrast(text, over(ImGui::ColorConvertU32ToFloat4(ui_color::kOverlay), picture)), kLeast)
          << fmt::format("{:08x}", word) << " on a sheet";
  }
}

/// No preset holds them: a save does not keep them.
TEST_F(Contrast, ClosingAsksAboutArguments) {
  EXPECT_EQ(window_.unsaved(*player_), "");
  player_->set("", "hero", {SettingType::text, {}, "lamp"});
  EXPECT_EQ(window_.unsaved(*player_), "1 argument, which no preset holds: they are given by --arg hero=lamp");
  player_->set("bloom", "intensity", {SettingType::number, {0.5}, ""});
  EXPECT_EQ(window_.unsaved(*player_),
            "1 setting of look.lua and 1 argument, which no preset holds: they are given by --arg hero=lamp");
}

}  // namespace
}  // namespace afterglow::test
