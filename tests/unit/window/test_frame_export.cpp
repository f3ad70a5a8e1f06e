// SPDX-License-Identifier: MIT
// Where S writes a frame, and what it does not write over.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>

#include "core/file.h"
#include "image/writer.h"
#include "window/frame_export.h"

namespace afterglow::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class FrameExports : public ::testing::Test {
 protected:
  FrameExports() : folder_(fs::temp_directory_path() / ("afterglow_frame_export" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
    std::ofstream(folder_ / "look.lua") << "local fx = require \"afterglow\"\nreturn fx.stack { fx.bloom {} }\n";
    for (const char* name : {"a.1.exr", "a.2.exr"}) {
      Picture picture;
      picture.color = Image(8, 4, 4);
      picture.data_window = picture.display_window = {0, 0, 8, 4};
      EXPECT_TRUE(write_picture(picture, folder_ / name, {}, diagnostics_));
    }
    device_ = Device::create({.device = "auto"}, diagnostics_).value();
    PlayerOptions options;
    options.preset = folder_ / "look.lua";
    options.footage.inputs = {(folder_ / "a.#.exr").string()};
    options.live.follow = false;
    player_ = Player::open(*device_, options, diagnostics_).value();
    turn();
  }
  ~FrameExports() override {
    player_.reset();
    std::error_code ec;
    fs::remove_all(folder_, ec);
  }

  void turn() {
    player_->settle();
    ASSERT_TRUE(player_->step());
  }
  /// What is said once the frame is written, or is not.
  std::string write(FrameExport& frames) {
    Ui ui;
    bool again = false;
    ui.again = [&] { again = true; };
    frames.begin(*player_, ui);
    do {
      again = false;
      frames.poll(ui);
    } while (again);
    const std::size_t name = ui.message.find(folder_.string());
    return name == std::string::npos ? ui.message : ui.message.erase(name, folder_.string().size() + 1);
  }

  fs::path folder_;
  Diagnostics diagnostics_;
  std::unique_ptr<Device> device_;
  std::unique_ptr<Player> player_;
};

TEST_F(FrameExports, WhatIsPlayedIsNotWrittenOver) {
  const std::string before = read_file(folder_ / "a.1.exr").value();
  for (const char* to : {"a.#.exr", "a.1.exr"}) {
    FrameExport frames(folder_ / to, diagnostics_);
    EXPECT_THAT(write(frames), HasSubstr("a.1.exr: error: it is played and would be overwritten by its own result"));
  }
  FrameExport other(folder_ / "a.2.exr", diagnostics_);
  EXPECT_THAT(write(other), HasSubstr("a.2.exr: error: it is played")) << "another frame of what is played";
  EXPECT_EQ(read_file(folder_ / "a.1.exr").value(), before);
}

TEST_F(FrameExports, FilesThatAreThereStay) {
  std::ofstream(folder_ / "out.exr") << "mine";
  FrameExport frames(folder_ / "out.exr", diagnostics_);
  EXPECT_EQ(write(frames), "written: out_2.exr");
  EXPECT_EQ(write(frames), "written: out_2.exr") << "the same frame again replaces its own file";
  player_->transport().go_to(1, player_->now());
  turn();
  EXPECT_EQ(write(frames), "written: out_3.exr") << "another frame does not";
  EXPECT_EQ(read_file(folder_ / "out.exr").value(), "mine");
  FrameExport later(folder_ / "out.exr", diagnostics_);
  EXPECT_EQ(write(later), "written: out_4.exr") << "what another session wrote is nobody's here";
}

TEST_F(FrameExports, NamesAreThoseOfTheFiles) {
  fs::copy_file(folder_ / "a.1.exr", folder_ / "take,2.exr");
  ASSERT_TRUE(player_->open_footage({(folder_ / "take,2.exr").string()}));
  turn();
  FrameExport folder(folder_ / "graded/", diagnostics_);
  EXPECT_EQ(write(folder), "written: graded/take,2_graded.exr");
}

TEST_F(FrameExports, BesideAVideoAndInANewFolder) {
  FrameExport video(folder_ / "out.mp4", diagnostics_);
  EXPECT_EQ(write(video), "written: a.1_graded.exr");
  FrameExport folder(folder_ / "graded/", diagnostics_);
  EXPECT_EQ(write(folder), "written: graded/a.1_graded.exr");
  EXPECT_TRUE(fs::exists(folder_ / "graded" / "a.1_graded.exr"));
}

}  // namespace
}  // namespace afterglow::test
