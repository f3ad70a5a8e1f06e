// SPDX-License-Identifier: MIT
// Real files as a row of frames.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/file.h"
#include "image/writer.h"
#include "play/footage.h"

namespace afterglow {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class FootageTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("afterglow-footage-" + std::to_string(::getpid()) + "-" +
                                           ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, float value) {
    Picture picture;
    picture.color = Image(4, 3, 4);
    picture.color.pixels.assign(picture.color.pixels.size(), value);
    picture.data_window = picture.display_window = {0, 0, 4, 3};
    ASSERT_TRUE(write_picture(picture, path(name), {}, diagnostics_).ok());
  }
  auto open(std::vector<std::string> inputs, const std::string& frames = "") {
    return Footage::open({std::move(inputs), frames, {}}, diagnostics_);
  }
  float value(const Footage& footage, int position) {
    const auto picture = footage.read(footage.frame(position).picture, {}, diagnostics_);
    return picture ? picture->color.pixels[0] : -1;
  }

  std::vector<std::string> messages_;
  Diagnostics diagnostics_{[this](Severity, const std::string& text) { messages_.push_back(text); }};
  fs::path folder_;
};

TEST_F(FootageTest, MissingFramesHoldTheOneBeforeAndAreReported) {
  for (const int number : {3, 4, 7}) write("shot.000" + std::to_string(number) + ".exr", static_cast<float>(number));
  const auto footage = open({path("shot.####.exr")}).value();
  ASSERT_EQ(footage->frames(), 5);
  EXPECT_EQ(footage->pictures(), 3);
  EXPECT_THAT(footage->missing(), ElementsAre(5, 6));
  EXPECT_EQ(footage->frame(2).number, 5);
  EXPECT_TRUE(footage->frame(2).held);
  EXPECT_EQ(value(*footage, 2), 4);
  EXPECT_EQ(value(*footage, 4), 7);
  EXPECT_EQ(footage->picture_name(footage->frame(3).picture), "shot.0004.exr");
  EXPECT_THAT(messages_, ElementsAre(HasSubstr("2 frames are missing, the picture before is held: 5-6")));
}

TEST_F(FootageTest, FilesThatAreLeftOutAreTold) {
  for (const char* name : {"s.1.exr", "s.2.exr", "s.0003.exr"}) write(name, 1);
  EXPECT_EQ(open({path("s.#.exr")}).value()->frames(), 2);
  EXPECT_THAT(messages_, ElementsAre(HasSubstr("s.0003.exr is left out")));
}

TEST_F(FootageTest, AListIsTakenInItsOrderAndItsStartMayBeMissing) {
  for (const int number : {2, 3}) write("a" + std::to_string(number) + ".exr", static_cast<float>(number));
  const auto footage = open({path("a%d.exr")}, "1-4").value();
  ASSERT_EQ(footage->frames(), 4);
  EXPECT_EQ(value(*footage, 0), 2) << "nothing lies before: the one behind";
  EXPECT_EQ(value(*footage, 3), 3);
  EXPECT_THAT(footage->missing(), ElementsAre(1, 4));
  EXPECT_THAT(open({path("a%d.exr")}, "8-9").error().text(), HasSubstr("none of the frames"));
}

TEST_F(FootageTest, FilesOneAfterTheOther) {
  write("b.exr", 1);
  write("a.exr", 2);
  const auto footage = open({path("b.exr"), path("a.exr")}).value();
  ASSERT_EQ(footage->frames(), 2);
  EXPECT_EQ(value(*footage, 0), 1);
  EXPECT_EQ(value(*footage, 1), 2);
  EXPECT_FALSE(footage->fps());
}

TEST_F(FootageTest, HeldFramesHaveTheContentOfThePicture) {
  write("s.1.exr", 1);
  write("s.3.exr", 1);
  const auto footage = open({path("s.#.exr")}).value();
  const auto first = footage->read(0, {}, diagnostics_).value(), third = footage->read(1, {}, diagnostics_).value();
  EXPECT_EQ(footage->frame(1).picture, footage->frame(0).picture);
  EXPECT_EQ(first.content.at("source"), third.content.at("source")) << "equal pixels of different files too";
}

TEST_F(FootageTest, WhatCannotBeReadFailsWhenItIsRead) {
  write("s.1.exr", 1);
  std::ofstream(path("s.2.exr")) << "no picture";
  const auto footage = open({path("s.#.exr")}).value();
  ASSERT_EQ(footage->frames(), 2);
  const auto broken = footage->read(1, {}, diagnostics_);
  ASSERT_FALSE(broken);
  EXPECT_EQ(broken.error().kind, ErrorKind::io);
  EXPECT_THAT(broken.error().file, HasSubstr("s.2.exr"));
  EXPECT_EQ(value(*footage, 0), 1);
}

TEST_F(FootageTest, WrongRequestsSayWhatIsWrong) {
  write("b.exr", 1);
  EXPECT_THAT(open({path("none.####.exr")}).error().text(), HasSubstr("no file matches"));
  EXPECT_THAT(open({path("b.exr")}, "1-2").error().text(), HasSubstr("--frames needs a numbered input"));
  EXPECT_EQ(open({}).error().kind, ErrorKind::usage);
}

TEST_F(FootageTest, VideosGiveTheirFramesAndTheirPace) {
  const std::string clip = std::string(AFTERGLOW_TEST_FOLDER) + "/images/video/clip.mp4";
  const auto footage = open({clip});
  ASSERT_TRUE(footage.ok()) << footage.error().text();
  EXPECT_EQ((*footage)->frames(), 24);
  EXPECT_EQ((*footage)->fps(), 24);
  EXPECT_TRUE((*footage)->is_video());
  const auto first = (*footage)->read(0, {}, diagnostics_).value();
  const auto late = (*footage)->read(20, {}, diagnostics_).value();
  EXPECT_EQ(first.color.size(), (Size{64, 36}));
  EXPECT_NE(first.content.at("source"), late.content.at("source"));
  // Back again: the decoder must seek.
  EXPECT_EQ((*footage)->read(0, {}, diagnostics_).value().content.at("source"), first.content.at("source"));
  EXPECT_EQ((*footage)->picture_name(20), "clip.mp4, frame 21");
  const auto some = open({clip}, "5-7").value();
  EXPECT_EQ(some->frames(), 3);
  EXPECT_EQ(some->frame(0).number, 5);
}

TEST_F(FootageTest, FilesThatOnlyLookLikeVideosAreRefused) {
  const std::string clip = std::string(AFTERGLOW_TEST_FOLDER) + "/images/video/clip.mkv";
  EXPECT_EQ(open({clip}).value()->frames(), 24);
  for (const char* head : {"\0\0\1\xba", "\x1a\x45\xdf\xa3", "RIFFxxxxAVI "}) {
    const std::string start = head[0] == 0 ? std::string(head, 4) : std::string(head);
    ASSERT_TRUE(write_file_atomically(path("x.mp4"), start + std::string(5000, '\1')));
    const auto refused = open({path("x.mp4")});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::io);
    EXPECT_THAT(refused.error().text(), HasSubstr("x.mp4: error: "));
    EXPECT_THAT(refused.error().text(), HasSubstr("video"));
  }
}

TEST_F(FootageTest, EachInputIsAClip) {
  for (const char* name : {"a.01.exr", "a.02.exr", "a.04.exr", "b.1.exr", "still.exr"}) write(name, 0);
  const auto footage = open({path("a.##.exr"), path("still.exr"), path("b.%d.exr")}).value();
  ASSERT_EQ(footage->clips().size(), 3u);
  EXPECT_EQ(footage->clips()[0].label, "a.##.exr");
  EXPECT_EQ(footage->clips()[0].frames, 4);
  EXPECT_EQ(footage->clips()[1].first, 4);
  EXPECT_EQ(footage->clips()[2].key, path("b.#.exr"));
  std::vector<int> clips;
  for (int at = 0; at < footage->frames(); ++at) clips.push_back(footage->clip_at(at));
  EXPECT_THAT(clips, ElementsAre(0, 0, 0, 0, 1, 2));
}

}  // namespace
}  // namespace afterglow
