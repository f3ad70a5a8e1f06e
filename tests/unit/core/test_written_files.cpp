// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "core/written_files.h"

namespace afterglow {
namespace {
namespace fs = std::filesystem;
using testing::HasSubstr;
using Paths = std::vector<fs::path>;

class WrittenFiles : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "afterglow-written-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
    put("a.exr", "pixels");
    put("look.lua", "return 1");
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path put(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  /// Why the files are refused; empty: they are not.
  std::string fault(const std::vector<SideFile>& sides, const Paths& outputs = {}) const {
    const auto checked = check_written(sides, outputs, Paths{folder_ / "a.exr", folder_ / "look.lua", "", "gone"});
    if (checked) return "";
    EXPECT_EQ(checked.error().kind, ErrorKind::usage);
    return checked.error().message;
  }

  fs::path folder_;
};

TEST_F(WrittenFiles, AreNoneOfThoseThatAreRead) {
  EXPECT_EQ(fault({{"--report", folder_ / "a.exr"}}), "is read, and --report would replace it");
  EXPECT_EQ(fault({{"-o", folder_ / "look.lua", FileForm::any}}), "is read, and -o would replace it");
  fs::create_symlink("a.exr", folder_ / "link.json");
  fs::create_hard_link(folder_ / "a.exr", folder_ / "same.json");
  EXPECT_THAT(fault({{"--report", folder_ / "link.json"}}), HasSubstr("is read"));
  EXPECT_THAT(fault({{"--report", folder_ / "same.json"}}), HasSubstr("is read"));
  EXPECT_THAT(fault({}, {folder_ / "b.exr", folder_ / "link.json"}), HasSubstr("is read as"));
  EXPECT_EQ(fault({{"--report", folder_ / "new.json"}}, {folder_ / "b.exr"}), "");
}

TEST_F(WrittenFiles, AreNoPacksOfWhichAFileIsRead) {
  put("pack.zip", "PK");
  const SideFile side{"--report", folder_ / "pack.zip", FileForm::any};
  const auto checked = check_written({&side, 1}, {}, Paths{folder_ / "pack.zip/presets/look.lua"});
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().message, "is read, and --report would replace it");
}

TEST_F(WrittenFiles, AreNotEachOther) {
  EXPECT_EQ(fault({{"--lock", folder_ / "j"}, {"--report", folder_ / "." / "j"}}),
            "--lock and --report would both be written there");
  EXPECT_EQ(fault({{"--report", folder_ / "b.png"}}, {folder_ / "a.png", folder_ / "b.png"}),
            "a result and --report would both be written there");
  fs::create_symlink("later.json", folder_ / "link.json");
  EXPECT_THAT(fault({{"--lock", folder_ / "later.json"}, {"--report", folder_ / "link.json"}}), HasSubstr("both"));
  EXPECT_EQ(fault({}, {folder_ / "a.mp4", folder_ / "a.mp4"}), "") << "all frames of a video";
}

TEST_F(WrittenFiles, TakeThePlaceOfTheirKindAlone) {
  const fs::path other = put("other.exr", "v/1\x01"), empty = put("empty", "");
  EXPECT_EQ(fault({{"--report", other}}), "is no JSON file, and --report would replace it");
  EXPECT_EQ(fault({{"-o", other, FileForm::dot}}), "is no graph file, and -o would replace it");
  EXPECT_EQ(fault({{"-o", other, FileForm::svg}}), "is no SVG file, and -o would replace it");
  EXPECT_EQ(fault({{"-o", other, FileForm::any}}), "");
  EXPECT_EQ(fault({{"--report", empty}}), "");
  EXPECT_EQ(fault({{"--report", put("r.json", "\n{\n}")}}), "");
  EXPECT_EQ(fault({{"-o", put("g.dot", "digraph a {"), FileForm::dot}}), "");
  EXPECT_EQ(fault({{"-o", put("g.svg", "<svg>"), FileForm::svg}}), "");
}

TEST_F(WrittenFiles, StreamsTakeNoFilesPlace) {
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  for (const fs::path& stream :
       {fs::path("-"), fs::path(), fs::path("/dev/null"), fs::path("/dev/stdout"), folder_ / "pipe"})
    EXPECT_EQ(fault({{"--lock", stream}, {"--report", stream}}), "") << stream;
}

}  // namespace
}  // namespace afterglow
