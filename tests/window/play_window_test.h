// SPDX-License-Identifier: MIT
// `afterglow play` in a real window: Xvfb, lavapipe, validation, and a user made of xdotool.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>

#include "core/file.h"
#include "image/reader.h"
#include "image/writer.h"
#include "played_window.h"
#include "x_client.h"
#include "xvfb.h"

namespace afterglow {
namespace fs = std::filesystem;

using Color = std::array<int, 3>;
inline constexpr Color kGray{188, 188, 188};  // sRGB code of 0.5
inline constexpr Color kRed{188, 0, 0}, kGreen{0, 188, 0}, kBlue{0, 0, 188};

class PlayWindow : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(xvfb_.runs()) << "Xvfb does not run";
    folder_ = fs::temp_directory_path() / ("afterglow_window" + std::to_string(getpid()));
    fs::create_directories(folder_);
    for (int frame = 1; frame <= 3; ++frame) write_picture_file("shot.000" + std::to_string(frame) + ".exr", 0.5f);
  }
  void TearDown() override {
    if (HasFailure() && program_) ADD_FAILURE() << program_->printed();
    program_.reset();
    std::error_code ec;
    fs::remove_all(folder_, ec);
  }

  using Light = std::array<float, 3>;
  /// Of 64×40 pixels.
  void write_picture_file(const std::string& name, const std::function<Light(int x, int y)>& light) {
    Picture picture;
    picture.color = Image(64, 40, 4);
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 64; ++x) {
        const Light rgb = light(x, y);
        float* pixel = &picture.color.pixels[static_cast<std::size_t>(y * 64 + x) * 4];
        std::copy(rgb.begin(), rgb.end(), pixel);
        pixel[3] = 1;
      }
    picture.data_window = picture.display_window = {0, 0, 64, 40};
    Diagnostics nowhere;
    const auto written = write_picture(picture, folder_ / name, {}, nowhere);
    ASSERT_TRUE(written) << written.error().text();
  }

  void write_picture_file(const std::string& name, const Light& light) {
    write_picture_file(name, [&](int, int) { return light; });
  }
  void write_picture_file(const std::string& name, float level) {
    write_picture_file(name, Light{level, level, level});
  }

  /// A look that keeps of each channel what `filter` says.
  void write_preset(const std::string& filter, const std::string& name = "look.lua") {
    std::ofstream(folder_ / name)
        << "local fx = require \"afterglow\"\n\n"
        << "return fx.stack {\n  name = \"test look\",\n  fx.color_adjustments { color_filter = " << filter
        << " },\n}\n";
  }

  /// Of a file that may not be there.
  std::string text_of(const std::string& name) {
    const auto text = read_file(folder_ / name);
    return text ? *text : "";
  }

  void play(std::vector<std::string> arguments) {
    program_ = std::make_unique<PlayedWindow>(xvfb_.display(), folder_, std::move(arguments));
  }

  Screen shot() { return screenshot(xvfb_.display(), (folder_ / "screen.ppm").string()); }
  bool user(const std::string& what) { return run_on(xvfb_.display(), "xdotool " + what) == 0; }

  /// Until the pixel at a point of the screen (parts of its size) has that colour.
  bool until_color(double x, double y, const Color& color) {
    return until([&] { return has_color(shot(), x, y, color); });
  }
  static bool has_color(const Screen& screen, double x, double y, const Color& color) {
    if (screen.rgb.empty()) return false;
    const std::uint8_t* rgb =
        screen.at(static_cast<int>(x * screen.size.width), static_cast<int>(y * screen.size.height));
    for (std::size_t i = 0; i < 3; ++i) {
      if (std::abs(rgb[i] - color[i]) > 2) return false;
    }
    return true;
  }
  static bool is(const std::uint8_t* rgb, const Color& color) {
    return rgb[0] == color[0] && rgb[1] == color[1] && rgb[2] == color[2];
  }
  static int count_color(const Screen& screen, const Color& color) {
    int count = 0;
    for (int y = 0; y < screen.size.height; ++y)
      for (int x = 0; x < screen.size.width; ++x) count += is(screen.at(x, y), color);
    return count;
  }
  /// The handle of a slider, orange, in the first row of the panel.
  bool shows_handle(int x) {
    const Screen screen = shot();
    return !screen.rgb.empty() && screen.at(x, 171)[0] > 110 && screen.at(x, 171)[2] < 60;
  }

  void expect_clean_end() {
    EXPECT_EQ(program_->finish(), 0);
    EXPECT_EQ(program_->printed().find("alidation"), std::string::npos);
  }

  Xvfb xvfb_;
  fs::path folder_;
  std::unique_ptr<PlayedWindow> program_;
};

/// The middle of the picture, clear of panel, transport and overlays.
inline constexpr double kX = 0.36, kY = 0.4;

}  // namespace afterglow
