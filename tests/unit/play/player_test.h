// SPDX-License-Identifier: MIT
// Playing without a window, on a device: a fake clock, real files.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "core/file.h"
#include "image/writer.h"
#include "play/player.h"

namespace afterglow {

namespace fs = std::filesystem;

inline constexpr Size kSize{16, 9};

class PlayerTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    Diagnostics none;
    device_ = Device::create({.device = "auto", .validate = true}, none).value();
  }
  static void TearDownTestSuite() { device_.reset(); }

  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("afterglow-player-" + std::to_string(::getpid()) + "-" +
                                           ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    write_look("look.lua", 1);
  }
  void TearDown() override {
    player_.reset();
    fs::remove_all(folder_);
    EXPECT_EQ(device_->validation_errors(), 0u)
        << (device_->validation_errors() ? device_->validation_messages().front() : "");
  }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const std::string& text) {
    ASSERT_TRUE(write_file_atomically(path(name), text).ok());
  }
  /// A look that doubles light `stops` times.
  void write_look(const std::string& name, double stops) {
    write(name,
          "local fx = require \"afterglow\"\nreturn fx.stack {\n  name = \"Look\",\n  fx.color_adjustments { "
          "post_exposure = " +
              std::to_string(stops) + " },\n}\n");
  }
  void write_picture_of(int number, float value) {
    Picture picture;
    picture.color = Image(kSize.width, kSize.height, 4);
    for (std::size_t i = 0; i < picture.color.pixels.size(); ++i) picture.color.pixels[i] = i % 4 == 3 ? 1.0f : value;
    picture.data_window = picture.display_window = {0, 0, kSize.width, kSize.height};
    Diagnostics none;
    ASSERT_TRUE(
        write_picture(picture, path("s." + std::to_string(number) + ".exr"), {.type = SampleType::float32}, none));
  }
  /// Frames 1…count with the values 1/8, 2/8, …
  void write_sequence(int count) {
    for (int i = 1; i <= count; ++i) write_picture_of(i, static_cast<float>(i) / 8);
  }
  Player& open(PlayerOptions options = {}) {
    if (options.preset.empty()) options.preset = path("look.lua");
    if (options.footage.inputs.empty()) options.footage.inputs = {path("s.#.exr")};
    options.live.follow = follow_;
    options.clock = [this] { return seconds_; };
    if (!options.fps) options.fps = 10;
    auto opened = Player::open(*device_, options, diagnostics_);
    if (!opened) ADD_FAILURE() << opened.error().text();
    player_ = std::move(opened).value();
    return *player_;
  }
  /// Everything that is under way comes in, then one turn.
  Step turn() {
    player_->settle();
    auto step = player_->step();
    if (!step) ADD_FAILURE() << step.error().text();
    return step.value();
  }
  Step reload() {
    player_->live().reload();
    return turn();
  }
  float result() { return player_->probe({3, 2}).value()->result[0]; }
  float source() { return player_->probe({3, 2}).value()->source[0]; }

  static inline std::unique_ptr<Device> device_;
  bool follow_ = false;  ///< else edits are told of by `reload`: then nothing waits for the system's watching
  double seconds_ = 100;
  std::vector<std::string> warnings_;
  Diagnostics diagnostics_{[this](Severity severity, const std::string& message) {
    if (severity == Severity::warning) warnings_.push_back(message);
  }};
  fs::path folder_;
  std::unique_ptr<Player> player_;
};

}  // namespace afterglow
