// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>

#include "core/file.h"
#include "core/file_record.h"
#include "core/paths.h"

namespace afterglow {
namespace {
namespace fs = std::filesystem;

class Record : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / ("afterglow_record_" + std::string(test->name()) + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  void write(const std::string& name, const std::string& text) {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  static FileProbes noted(const std::function<void(FileRecord&)>& work) {
    FileRecord record;
    work(record);
    return *record.looks();
  }
  fs::path folder_;
};

TEST_F(Record, ComparesContents) {
  write("a", "one");
  const auto looks = noted([&](FileRecord& record) { EXPECT_TRUE(read_file(folder_ / "a", 100, &record).ok()); });
  EXPECT_FALSE(first_changed(looks));
  write("a", "one");
  EXPECT_FALSE(first_changed(looks)) << "saved without a change";
  write("a", "two");
  EXPECT_EQ(first_changed(looks), folder_ / "a");
  EXPECT_EQ(first_changed(looks, true), folder_ / "a") << "as old and as large, but too young to be trusted";
  fs::remove(folder_ / "a");
  EXPECT_EQ(first_changed(looks), folder_ / "a");
}

TEST_F(Record, MayKeepWhatWasRead) {
  write("a", "one");
  const auto record = FileRecord::keeping();
  EXPECT_EQ(read_file(folder_ / "a", 100, record.get()).value(), "one");
  EXPECT_FALSE(is_file(folder_ / "b", record.get()));
  const auto looks = record->looks();
  write("a", "two");
  EXPECT_EQ(read_file(folder_ / "a", 100, record.get()).value(), "one");
  EXPECT_EQ(read_file(folder_ / "a", 100).value(), "two") << "others see what there is";
  fs::remove(folder_ / "a");
  EXPECT_EQ(read_file(folder_ / "a", 100, record.get()).value(), "one");
  EXPECT_TRUE(is_file(folder_ / "a", record.get()));
  EXPECT_EQ(record->looks(), looks) << "nothing was looked at again";
  write("b", "new");
  EXPECT_TRUE(is_file(folder_ / "b", record.get()));
}

TEST_F(Record, NotesWhatWasLookedForInVain) {
  const auto looks = noted([&](FileRecord& record) {
    EXPECT_FALSE(read_file(folder_ / "missing", 100, &record).ok());
    EXPECT_FALSE(is_file(folder_ / "effects" / "glow.lua", &record));
  });
  EXPECT_FALSE(first_changed(looks));
  write("effects/glow.lua", "");
  EXPECT_EQ(first_changed(looks), folder_ / "effects" / "glow.lua");
  fs::remove_all(folder_ / "effects");
  EXPECT_FALSE(first_changed(looks));
  write("missing", "");
  EXPECT_EQ(first_changed(looks), folder_ / "missing");
}

TEST_F(Record, NamesEveryPlaceOfASearchPath) {
  write("second/shaders/glow/a.glsl", "");
  SearchPath path;
  path.user = {folder_ / "first", folder_ / "second"};
  path.installation = folder_ / "third";
  path.record = std::make_shared<FileRecord>();
  EXPECT_EQ(path.find_shader("glow/a.glsl").size(), 1U);
  const FileProbes looks = *path.record->looks();
  EXPECT_FALSE(first_changed(looks));
  write("first/shaders/glow/a.glsl", "");
  EXPECT_EQ(first_changed(looks), folder_ / "first" / "shaders" / "glow" / "a.glsl") << "shadows the other";
}

TEST_F(Record, ErrorsOfReadingAreTheSameTheNextTime) {
  write("large", std::string(100, 'x'));
  fs::create_directory(folder_ / "folder");
  const auto looks = noted([&](FileRecord& record) {
    EXPECT_FALSE(read_file(folder_ / "large", 10, &record).ok());
    EXPECT_FALSE(read_file(folder_ / "folder", 100, &record).ok());
  });
  EXPECT_EQ(looks.size(), 2U);
  EXPECT_FALSE(first_changed(looks));
}

TEST_F(Record, KnowsLargeFilesByTheirStamps) {
  constexpr std::uintmax_t kLarge = (64u << 20) + 1;
  write("large", "");
  fs::resize_file(folder_ / "large", kLarge);
  const auto looks = noted([&](FileRecord& record) {
    EXPECT_TRUE(read_file(folder_ / "large", kLarge, &record).ok());
    EXPECT_FALSE(read_file(folder_ / "large", kLarge - 1, &record).ok());
  });
  EXPECT_FALSE(first_changed(looks));
  EXPECT_FALSE(first_changed(looks, true));
  fs::resize_file(folder_ / "large", kLarge + 1);
  EXPECT_EQ(first_changed(looks), folder_ / "large");
}

TEST_F(Record, FilesHaveTheHashOfTheirContent) {
  for (const std::size_t size : {0u, 1u, 65536u, 65537u, 300000u}) {
    std::string text(size, 'x');
    if (size > 0) text.back() = 'y';
    write("a", text);
    EXPECT_EQ(hash_file(folder_ / "a").value(), hash_text(text)) << size;
  }
  EXPECT_FALSE(hash_file(folder_).ok());
  EXPECT_FALSE(hash_file(folder_ / "missing").ok());
}

TEST_F(Record, ListsFolders) {
  const auto looks = noted([&](FileRecord& record) { record.note(folder_ / "packs", FileProbe::Kind::listing); });
  EXPECT_FALSE(first_changed(looks));
  write("packs/a.zip", "");
  EXPECT_TRUE(first_changed(looks));
  EXPECT_EQ(paths_to_watch(looks), std::vector<fs::path>{folder_ / "packs" / ""});
}

TEST_F(Record, WhatSaysMostCountsAndStaysTheSameValueUntilSomethingIsAdded) {
  write("a", "one");
  FileRecord record;
  EXPECT_TRUE(is_file(folder_ / "a", &record));
  const auto before = record.looks();
  EXPECT_EQ(before->at(folder_ / "a").kind, FileProbe::Kind::existence);
  EXPECT_TRUE(is_file(folder_ / "a", &record));
  EXPECT_EQ(record.looks(), before) << "nothing new";
  EXPECT_TRUE(read_file(folder_ / "a", 100, &record).ok());
  EXPECT_TRUE(is_file(folder_ / "a", &record));
  EXPECT_EQ(record.looks()->at(folder_ / "a").kind, FileProbe::Kind::content);
  EXPECT_EQ(before->at(folder_ / "a").kind, FileProbe::Kind::existence) << "what was handed out stays as it is";
  EXPECT_TRUE(read_file(folder_ / "a").ok()) << "without a record";
}

}  // namespace
}  // namespace afterglow
