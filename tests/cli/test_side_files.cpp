// SPDX-License-Identifier: MIT
// What is written by the wish of an option, and results, never take the place of pictures and looks.
#include "cli_test.h"

namespace afterglow::test {
namespace {

class SideFiles : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    make_preset("look.lua");
    make_exr("a.exr");
  }
};

class LostFiles : public SideFiles, public ::testing::WithParamInterface<std::vector<std::string>> {};

/// Words, and behind them the file that they would destroy.
TEST_P(LostFiles, AreRefused) {
  write("text.txt", "notes of years\n");
  make_exr("z.exr");
  fs::copy_file(path("a.exr"), path("b.exr"));
  fs::create_directory(path("out"));
  auto words = GetParam();
  const std::string victim = words.back();
  words.pop_back();
  const auto before = files();
  const std::string content = read(victim);
  const Outcome outcome = run(words);
  EXPECT_EQ(outcome.exit_code, kUsage) << outcome.err;
  EXPECT_TRUE(is_one_error_line(outcome.err)) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr(victim + ": error: "));
  EXPECT_EQ(files(), before) << "before anything runs";
  EXPECT_TRUE(read(victim) == content);
}

INSTANTIATE_TEST_SUITE_P(
    Cli, LostFiles,
    ::testing::Values(
        std::vector<std::string>{"run", "look.lua", "-o", "out/", "--format", "png", "--report", "a.exr", "b.exr",
                                 "a.exr"},
        std::vector<std::string>{"run", "look.lua", "a.exr", "-o", "q.png", "--report", "q.png", "q.png"},
        std::vector<std::string>{"run", "look.lua", "a.exr", "-o", "q.png", "--report", "r", "--lock", "r", "r"},
        std::vector<std::string>{"run", "look.lua", "a.exr", "-o", "q.png", "--report", "look.lua", "look.lua"},
        std::vector<std::string>{"run", "look.lua", "a.exr", "-o", "q.png", "--lock", "a.exr", "a.exr"},
        std::vector<std::string>{"run", "look.lua", "a.exr", "-o", "q.png", "--depth", "z.exr", "--lock", "z.exr",
                                 "z.exr"},
        std::vector<std::string>{"run", "look.lua", "a.exr", "-o", "q.png", "--report", "text.txt", "text.txt"},
        std::vector<std::string>{"farm", "look.lua", "a.exr", "-o", "out/", "--jobs", "a.exr", "a.exr"},
        std::vector<std::string>{"graph", "look.lua", "-o", "look.lua", "--format", "dot", "look.lua"},
        std::vector<std::string>{"graph", "look.lua", "-o", "text.txt", "--format", "svg", "text.txt"},
        std::vector<std::string>{"play", "look.lua", "a.exr", "--headless", "--screenshot", "a.exr", "a.exr"},
        std::vector<std::string>{"play", "look.lua", "a.exr", "--headless", "--report", "look.lua", "look.lua"}));

TEST_F(SideFiles, TakeTheirOwnPlace) {
  for (int time = 0; time < 2; ++time) {
    const Outcome outcome = run({"run", "look.lua", "a.exr", "-o", "q.png", "--report", "r.json", "--lock", "l.json"});
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    EXPECT_EQ(run({"graph", "look.lua", "-o", "g.dot"}).exit_code, kDone);
    EXPECT_EQ(run({"graph", "look.lua", "-o", "g.svg"}).exit_code, kDone);
    EXPECT_EQ(run({"graph", "look.lua", "-o", "g.txt", "--traffic"}).exit_code, kDone);
  }
  EXPECT_EQ(run({"run", "look.lua", "a.exr", "-o", "q.png", "--report", "/dev/null"}).exit_code, kDone);
}

TEST_F(SideFiles, AndResultsTakeThePlaceOfNoFileOfTheLook) {
  const std::string begin = "local fx = require \"afterglow\"\nreturn fx.stack { ";
  write("cube.lua", begin + "fx.lut { file = \"t.cube\" } }\n");
  write("fade.lua", begin + "fx.transition { to = \"t.png\", progress = 0.5 } }\n");
  ASSERT_EQ(run({"bake", "look.lua", "-o", "t.cube"}).exit_code, kDone);
  ASSERT_EQ(run({"run", "look.lua", "a.exr", "-o", "t.png"}).exit_code, kDone);
  for (const auto& words :
       {std::vector<std::string>{"run", "fade.lua", "a.exr", "-o", "t.png"},
        std::vector<std::string>{"play", "fade.lua", "a.exr", "--headless", "--screenshot", "t.png"},
        std::vector<std::string>{"bake", "cube.lua", "-o", "t.cube"}}) {
    const std::string table = read(words.back());
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.exit_code, kUsage) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(words.back() + ": error: is read"));
    EXPECT_TRUE(read(words.back()) == table) << words[0];
  }
}

}  // namespace
}  // namespace afterglow::test
