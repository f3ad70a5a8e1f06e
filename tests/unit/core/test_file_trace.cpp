#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "core/file.h"
#include "core/file_trace.h"
#include "core/paths.h"

namespace afterglow {
namespace {
namespace fs = std::filesystem;

class Trace : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / ("afterglow_trace_" + std::string(test->name()) + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  void write(const std::string& name, const std::string& text) {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  FileLooks traced(const std::function<void()>& work) {
    const FileTrace trace;
    work();
    return trace.looks();
  }
  fs::path folder_;
};

TEST_F(Trace, ComparesContents) {
  write("a", "one");
  const auto looks = traced([&] { EXPECT_TRUE(read_file(folder_ / "a").ok()); });
  EXPECT_FALSE(first_changed(looks));
  write("a", "one");
  EXPECT_FALSE(first_changed(looks)) << "saved without a change";
  write("a", "two");
  EXPECT_EQ(first_changed(looks), folder_ / "a");
  EXPECT_EQ(first_changed(looks, true), folder_ / "a") << "as old and as large, but too young to be trusted";
  fs::remove(folder_ / "a");
  EXPECT_EQ(first_changed(looks), folder_ / "a");
}

TEST_F(Trace, NotesWhatWasLookedForInVain) {
  const auto looks = traced([&] {
    EXPECT_FALSE(read_file(folder_ / "missing").ok());
    EXPECT_FALSE(is_file(folder_ / "effects" / "glow.lua"));
  });
  EXPECT_FALSE(first_changed(looks));
  write("effects/glow.lua", "");
  EXPECT_EQ(first_changed(looks), folder_ / "effects" / "glow.lua");
  fs::remove_all(folder_ / "effects");
  EXPECT_FALSE(first_changed(looks));
  write("missing", "");
  EXPECT_EQ(first_changed(looks), folder_ / "missing");
}

TEST_F(Trace, NamesEveryPlaceOfASearchPath) {
  write("second/shaders/glow/a.glsl", "");
  SearchPath path;
  path.user = {folder_ / "first", folder_ / "second"};
  path.installation = folder_ / "third";
  const auto looks = traced([&] { EXPECT_EQ(path.find_shader("glow/a.glsl").size(), 1U); });
  EXPECT_FALSE(first_changed(looks));
  write("first/shaders/glow/a.glsl", "");
  EXPECT_EQ(first_changed(looks), folder_ / "first" / "shaders" / "glow" / "a.glsl") << "shadows the other";
}

TEST_F(Trace, ErrorsOfReadingAreTheSameTheNextTime) {
  write("large", std::string(100, 'x'));
  fs::create_directory(folder_ / "folder");
  const auto looks = traced([&] {
    EXPECT_FALSE(read_file(folder_ / "large", 10).ok());
    EXPECT_FALSE(read_file(folder_ / "folder").ok());
  });
  EXPECT_EQ(looks.size(), 2U);
  EXPECT_FALSE(first_changed(looks));
}

TEST_F(Trace, ListsFolders) {
  const auto looks = traced([&] { FileTrace::note(folder_ / "packs", FileLook::Kind::listing); });
  EXPECT_FALSE(first_changed(looks));
  write("packs/a.zip", "");
  EXPECT_TRUE(first_changed(looks));
  EXPECT_EQ(paths_to_watch(looks), std::vector<fs::path>{folder_ / "packs" / ""});
}

TEST_F(Trace, BelongsToItsThreadAndNests) {
  write("a", "one");
  const FileTrace outer;
  {
    const FileTrace inner;
    EXPECT_TRUE(read_file(folder_ / "a").ok());
    EXPECT_EQ(inner.looks().size(), 1U);
  }
  std::thread([&] { EXPECT_TRUE(read_file(folder_ / "a").ok()); }).join();
  EXPECT_TRUE(outer.looks().empty());
}

}  // namespace
}  // namespace afterglow
