// SPDX-License-Identifier: MIT
// Caches that cannot be written: ours, and that which Mesa's drivers keep for themselves.
#include <fstream>

#include "cli_test.h"
#include "small_disk.h"

namespace afterglow::test {
namespace {

class FullCaches : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    make_exr("a.exr");
    make_preset("look.lua");
    ASSERT_EQ(make("usual", "usual.exr").exit_code, kDone);
  }
  /// With all caches below a folder.
  Outcome make(const std::string& caches, const std::string& output, const std::vector<std::string>& more = {}) const {
    RunOptions options;
    options.environment["AFTERGLOW_CACHE"] = text(caches + "/own");
    options.environment["MESA_SHADER_CACHE_DIR"] = text(caches);
    std::vector<std::string> all{"run", "look.lua", "a.exr", "-o", output};
    all.insert(all.end(), more.begin(), more.end());
    return run(all, options);
  }
};

TEST_F(FullCaches, AFullDiskIsNoReasonToFail) {
  fs::create_directory(path("disk"));
  const SmallDisk disk(path("disk"), "4m");
  if (!disk.is_mounted()) GTEST_SKIP() << "no disk can be mounted here";
  // The driver's file with holes, of a run that had room; then without it.
  ASSERT_EQ(make("disk", "first.exr").exit_code, kDone);
  for (const bool known : {true, false}) {
    fs::remove(path("disk/fill"));
    if (!known) fs::remove_all(path("disk/mesa_shader_cache"));
    std::ofstream(path("disk/fill")) << std::string(5 << 20, 'x');
    const Outcome outcome = make("disk", "full.exr", {"-v"});
    ASSERT_EQ(outcome.exit_code, kDone) << known << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("the disk is full; the driver compiles shaders without its cache")) << known;
    EXPECT_THAT(outcome.err, Not(HasSubstr("warning"))) << known;
    EXPECT_TRUE(read("full.exr") == read("usual.exr")) << known;
  }
}

TEST_F(FullCaches, APlaceThatIsNoFolderIsNoReasonToFail) {
  write("file", "");
  const Outcome outcome = make("file", "a2.exr");
  EXPECT_EQ(outcome.exit_code, kDone);
  EXPECT_EQ(outcome.err, "");
  EXPECT_TRUE(read("a2.exr") == read("usual.exr"));
}

}  // namespace
}  // namespace afterglow::test
