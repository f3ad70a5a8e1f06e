// SPDX-License-Identifier: MIT
// What is compared is named by its file.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>

#include "image/writer.h"
#include "window/overlay.h"

namespace afterglow::test {
namespace {

namespace fs = std::filesystem;

class ComparisonText : public ::testing::Test {
 protected:
  ComparisonText() : folder_(fs::temp_directory_path() / ("afterglow_comparison" + std::to_string(getpid()))) {
    for (const char* name : {"look.lua", "warm.lua", "shot/look.lua"}) {
      fs::create_directories((folder_ / name).parent_path());
      std::ofstream(folder_ / name) << "local fx = require \"afterglow\"\nreturn fx.stack { fx.bloom {} }\n";
    }
    Picture picture;
    picture.color = Image(8, 4, 4);
    picture.data_window = picture.display_window = {0, 0, 8, 4};
    EXPECT_TRUE(write_picture(picture, folder_ / "a.exr", {}, diagnostics_));
    device_ = Device::create({.device = "auto"}, diagnostics_).value();
  }
  ~ComparisonText() override {
    player_.reset();
    std::error_code ec;
    fs::remove_all(folder_, ec);
  }

  void open(const std::string& other) {
    PlayerOptions options;
    options.preset = folder_ / "look.lua";
    if (!other.empty()) options.other_preset = folder_ / other;
    options.footage.inputs = {(folder_ / "a.exr").string()};
    options.live.follow = false;
    player_ = Player::open(*device_, options, diagnostics_).value();
  }
  std::string text(Compare compare, CompareBy by) {
    player_->view().compare = compare;
    player_->view().by = by;
    return comparison_text(*player_);
  }

  fs::path folder_;
  Diagnostics diagnostics_;
  std::unique_ptr<Device> device_;
  std::unique_ptr<Player> player_;
};

TEST_F(ComparisonText, NamesPresetsByTheirFiles) {
  open("warm.lua");
  EXPECT_EQ(text(Compare::other, CompareBy::wipe), "warm.lua | look.lua");
  EXPECT_EQ(text(Compare::other, CompareBy::side_by_side), "warm.lua | look.lua");
  EXPECT_EQ(text(Compare::other, CompareBy::flip), "B: warm.lua");
  EXPECT_EQ(text(Compare::other, CompareBy::difference), "difference from warm.lua");
  EXPECT_EQ(text(Compare::source, CompareBy::wipe), "before | after");
  EXPECT_EQ(text(Compare::none, CompareBy::wipe), "result");
  ASSERT_TRUE(player_->open_other(folder_ / "look.lua"));
  EXPECT_EQ(text(Compare::other, CompareBy::flip), "B: " + (folder_.filename() / "look.lua").string());
}

TEST_F(ComparisonText, FilesOfOneNameBringTheirFolders) {
  open("shot/look.lua");
  EXPECT_EQ(text(Compare::other, CompareBy::wipe), "shot/look.lua | " + (folder_.filename() / "look.lua").string());
  open("");
  EXPECT_EQ(text(Compare::source, CompareBy::flip), "before");
  EXPECT_EQ(text(Compare::source, CompareBy::difference), "difference from what went in");
}

TEST(FrameMark, SaysWhatIsShown) {
  ShownFrame shown;
  shown.number = 5;
  shown.name = "s.0004.exr";
  EXPECT_EQ(frame_mark_text(shown, true), "Frame 5 is missing; s.0004.exr is shown");
  shown.unreadable = Error{ErrorKind::io, "damaged"};
  EXPECT_EQ(frame_mark_text(shown, true), "Frame 5 cannot be read; an earlier picture is shown");
  EXPECT_EQ(frame_mark_text(shown, false), "Frame 5 cannot be read") << "there was none before";
}

}  // namespace
}  // namespace afterglow::test
