// SPDX-License-Identifier: MIT
// Inputs that a renderer still writes, and folders as inputs.
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "cli_test.h"

namespace afterglow::test {
namespace {

/// Steps that are taken one after the other, each when the one before has come about.
class Steps {
 public:
  struct Step {
    std::function<bool()> when;
    std::function<void()> then;
  };
  explicit Steps(std::vector<Step> steps) : steps_(std::move(steps)) {}
  bool operator()(int) {
    if (next_ < steps_.size() && steps_[next_].when()) steps_[next_++].then();
    return next_ == steps_.size();
  }

 private:
  std::vector<Step> steps_;
  std::size_t next_ = 0;
};

class Watch : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    make_preset("look.lua");
    for (const char* folder : {"in", "out", "one"}) fs::create_directory(path(folder));
    for (int frame = 1; frame <= 4; ++frame) make_exr(made(frame), 60 + frame, 36);
  }
  static std::string name(int frame) { return "shot.000" + std::to_string(frame) + ".exr"; }
  static std::string made(int frame) { return "made/" + name(frame); }
  /// As renderers do that write beside and rename.
  void give(int frame, const std::string& from) const {
    fs::copy_file(path(from), path("in/beside.tmp"), fs::copy_options::overwrite_existing);
    fs::rename(path("in/beside.tmp"), path("in/" + name(frame)));
  }
  void give(int frame) const { give(frame, made(frame)); }
  std::function<bool()> there(int frame) const {
    return [this, frame] { return fs::exists(path("out/" + name(frame))); };
  }
  static bool at_once() { return true; }
  Outcome watch(const std::string& frames, Steps steps, const std::vector<std::string>& more = {}) const {
    RunOptions options;
    options.meanwhile = std::move(steps);
    options.limit = std::chrono::seconds(60);
    std::vector<std::string> words{"run", "look.lua", "in/shot.####.exr", "-o", "out/", "--watch", "--frames", frames};
    words.insert(words.end(), more.begin(), more.end());
    return run(words, options);
  }
  void expect_as_one_run(const std::string& frames, int count) const {
    ASSERT_EQ(run({"run", "look.lua", "in/shot.####.exr", "-o", "one/", "--frames", frames}).exit_code, kDone);
    int found = 0;
    for (const auto& entry : fs::directory_iterator(path("one")))
      if (entry.is_regular_file()) {
        const std::string file = entry.path().filename().string();
        EXPECT_TRUE(read("one/" + file) == read("out/" + file)) << file;
        ++found;
      }
    EXPECT_EQ(found, count);
  }
};

TEST_F(Watch, FramesRunAsTheyAppearWhole) {
  const std::string whole = read(made(2));
  std::ofstream writer;
  const Outcome outcome = watch("1-3", Steps({{at_once, [&] { give(1); }},
                                              {there(1),
                                               [&] {
                                                 writer.open(path("in/" + name(2)), std::ios::binary);
                                                 writer << whole.substr(0, whole.size() / 2) << std::flush;
                                                 give(3);
                                               }},
                                              {there(3), [&] {
                                                 EXPECT_FALSE(there(2)()) << "a frame that is still being written";
                                                 writer << whole.substr(whole.size() / 2);
                                                 writer.close();
                                               }}}));
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outcome.err, IsEmpty());
  expect_as_one_run("1-3", 3);
}

TEST_F(Watch, AFrameThatChangesIsMadeAgain) {
  std::string first;
  const Outcome outcome = watch("1-2", Steps({{at_once, [&] { give(1, made(3)); }},
                                              {there(1),
                                               [&] {
                                                 first = read("out/" + name(1));
                                                 give(1);
                                               }},
                                              {[&] { return read("out/" + name(1)) != first; }, [&] { give(2); }}}));
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_FALSE(first.empty());
  expect_as_one_run("1-2", 2);
}

TEST_F(Watch, ABadFrameIsToldAndWaitedFor) {
  make_truncated_exr("bad.exr");
  fs::last_write_time(path("bad.exr"), fs::file_time_type::clock::now() - std::chrono::hours(1));  // nobody writes it
  bool bad_was_seen = false;
  const auto give_bad = [&] { fs::rename(path("bad.exr"), path("in/" + name(1))); };
  const auto mend = [&] {
    bad_was_seen = !there(1)();
    give(1);
  };
  const Outcome outcome = watch("1-2", Steps({{at_once, give_bad}, {at_once, [&] { give(2); }}, {there(2), mend}}));
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_TRUE(bad_was_seen);
  EXPECT_THAT(outcome.err, HasSubstr("in/shot.0001.exr: error: "));
  expect_as_one_run("1-2", 2);
}

TEST_F(Watch, AFrameThatFailedIsNoneOfThoseThatCameLater) {
  make_truncated_exr("bad.exr");
  give(1, "bad.exr");
  fs::last_write_time(path("in/" + name(1)), fs::file_time_type::clock::now() - std::chrono::hours(1));
  give(2);
  const Outcome outcome = watch("1-3", Steps({{there(2), [&] { give(3); }}, {there(3), [&] { give(1); }}}));
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("in/shot.0001.exr: error: "));
  EXPECT_THAT(outcome.err, Not(HasSubstr("frames failed"))) << "each is told by its name";
  expect_as_one_run("1-3", 3);
}

/// Its writer has closed it and goes on with it: no error is told of what was half there.
TEST_F(Watch, AFileThatIsWrittenInTwoGoesIsNoError) {
  const std::string whole = read(made(1)), half = whole.substr(0, whole.size() / 2);
  const auto put = [&](const std::string& bytes) {
    std::ofstream(path("in/" + name(1)), std::ios::binary | std::ios::app) << bytes;
  };
  const Outcome outcome = watch("1-3", Steps({{at_once, [&] { put(half); }},
                                              {at_once, [&] { give(2); }},
                                              {there(2), [&] { give(3); }},
                                              {there(3), [&] { put(whole.substr(half.size())); }}}));
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outcome.err, IsEmpty());
  expect_as_one_run("1-3", 3);
}

TEST_F(Watch, AFileThatStaysHalfWrittenIsToldAtTheEnd) {
  const std::string whole = read(made(1));
  bool written = false;
  RunOptions options;
  options.meanwhile = [&](int process) {
    if (!std::exchange(written, true)) {
      std::ofstream(path("in/" + name(1)), std::ios::binary) << whole.substr(0, whole.size() / 2);
      give(2);
    }
    if (there(2)() && !fs::exists(path("in/" + name(3)))) give(3);
    return there(3)() && kill(process, SIGINT) == 0;
  };
  options.limit = std::chrono::seconds(60);
  const Outcome outcome =
      run({"run", "look.lua", "in/shot.####.exr", "-o", "out/", "--watch", "--frames", "1-3"}, options);
  EXPECT_EQ(outcome.exit_code, kInterrupted) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("in/shot.0001.exr: error: "));
}

TEST_F(Watch, FramesThatLookBackWaitForThoseBefore) {
  for (int frame = 1; frame <= 4; ++frame) make_exr(made(frame));
  write("effects/back.lua", R"(
local fx = require "afterglow"
return fx.effect { name = "back", settings = {}, build = function(g, s, source)
  local before = g:history { size = { 1, 1 }, pre_roll = 1 }
  g:keep(before, g:pass { shader = "back/propagate", source = source, before = before, size = { 1, 1 } })
  return g:pass { shader = "back/show", source = source, before = before }
end })");
  write("shaders/back/propagate.glsl",
        "uniform sampler2D source;\nuniform sampler2D before;\n"
        "vec4 sample_at(ivec2 p) { return fetch(source, ivec2(30, 18)) + 0.0 * fetch(before, p); }\n");
  write("shaders/back/show.glsl",
        "uniform sampler2D before;\nvec4 apply(vec4 color) { return color + fetch(before, ivec2(0)); }\n");
  write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.back {} }\n");
  make_exr("other.exr", 64, 37);
  std::string third;
  const Outcome outcome = watch("1-4", Steps({{at_once, [&] { give(1); }},
                                              {there(1), [&] { give(3); }},
                                              {at_once, [&] { give(4); }},  // it needs the third alone
                                              {there(4),
                                               [&] {
                                                 EXPECT_FALSE(there(3)()) << "its second is not there";
                                                 give(2);
                                               }},
                                              {there(3), [] {}}}));
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  expect_as_one_run("1-4", 4);
}

TEST_F(Watch, EndsWhenItIsAskedTo) {
  RunOptions options;
  options.meanwhile = [&](int process) {
    if (!there(1)()) return false;
    kill(process, SIGTERM);
    return true;
  };
  give(1);
  const Outcome outcome =
      run({"run", "look.lua", "in/shot.####.exr", "-o", "out/", "--watch", "--frames", "1-2"}, options);
  EXPECT_EQ(outcome.exit_code, kInterrupted) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("interrupted"));
}

TEST_F(Watch, NeedsAnEnd) {
  const Outcome outcome = run({"run", "look.lua", "in/shot.####.exr", "-o", "out/", "--watch"});
  EXPECT_EQ(outcome.exit_code, kUsage);
  EXPECT_TRUE(is_one_error_line(outcome.err));
  EXPECT_THAT(outcome.err, HasSubstr("--watch needs --frames"));
}

TEST_F(Watch, AFolderIsItsSequence) {
  for (int frame = 1; frame <= 3; ++frame) give(frame);
  write("in/notes.12.txt", "no picture");
  ASSERT_EQ(run({"run", "look.lua", "in", "-o", "out/", "--frames", "2-3"}).exit_code, kDone);
  expect_as_one_run("2-3", 2);
  EXPECT_FALSE(there(1)());
  const Outcome played = run({"play", "look.lua", "in/", "--headless", "--fast", "--report", "play.json"});
  EXPECT_EQ(played.exit_code, kDone) << played.err;
  fs::copy_file(path(made(1)), path("in/other.0001.exr"));
  const Outcome several = run({"run", "look.lua", "in", "-o", "out/"});
  EXPECT_EQ(several.exit_code, kFiles);
  EXPECT_TRUE(is_one_error_line(several.err));
  EXPECT_THAT(several.err,
              HasSubstr("in: error: the folder holds several sequences; allowed: in/other.####.exr, in/shot.####.exr"));
  fs::create_directory(path("empty"));
  const Outcome none = run({"run", "look.lua", "empty", "-o", "out/"});
  EXPECT_EQ(none.exit_code, kFiles);
  EXPECT_THAT(none.err, HasSubstr("empty: error: the folder holds no numbered pictures"));
}

}  // namespace
}  // namespace afterglow::test
