// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include <csignal>

#include "core/process.h"

namespace afterglow {
namespace {

using testing::HasSubstr;

Result<ProcessEnd> shell(const std::string& text, const ProcessOptions& options = {}) {
  return run_process({"sh", "-c", text}, options);
}

TEST(Process, WhatItSays) {
  const auto end = shell("echo said; echo complained >&2; cat");
  ASSERT_TRUE(end) << end.error().text();
  EXPECT_EQ(end->code, 0);
  EXPECT_EQ(end->out, "said\n");
  EXPECT_EQ(end->err, "complained\n");
}

TEST(Process, ErrorsGoWhereOursGo) {
  testing::internal::CaptureStderr();
  const auto end = shell("echo said; echo complained >&2", {.environment = {}, .show_errors = true});
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "complained\n");
  ASSERT_TRUE(end) << end.error().text();
  EXPECT_EQ(end->out, "said\n");
  EXPECT_EQ(end->err, "");
}

TEST(Process, VariablesInsteadOfOursAndBesides) {
  const auto end = shell("printf '%s %s' \"$HOME\" \"$AFTERGLOW_TRIAL\"; env | grep -c ^HOME=",
                         {.environment = {{"HOME", "here"}, {"AFTERGLOW_TRIAL", "seven"}}});
  ASSERT_TRUE(end) << end.error().text();
  EXPECT_EQ(end->out, "here seven1\n");
}

TEST(Process, HowItEnded) {
  const auto failed = shell("exit 4"), killed = shell("kill -9 $$");
  ASSERT_TRUE(failed && killed);
  EXPECT_EQ(failed->code, 4);
  EXPECT_EQ(failed->text(), "ended with exit code 4");
  EXPECT_EQ(killed->code, 128 + 9);
  EXPECT_EQ(killed->text(), "was ended by signal 9");
}

// Programs expect to end when nobody reads what they say, whatever we do ourselves.
TEST(Process, HearsTheSignalsThatWeIgnore) {
  const auto before = std::signal(SIGPIPE, SIG_IGN);
  const auto end = shell("sed -n 's/^SigIgn:.//p' /proc/self/status");
  std::signal(SIGPIPE, before);
  ASSERT_TRUE(end) << end.error().text();
  EXPECT_EQ(std::stoull(end->out, nullptr, 16) >> (SIGPIPE - 1) & 1, 0u) << end->out;
}

TEST(Process, WhatCannotBeStarted) {
  const auto none = run_process({"/nowhere/at all"});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().kind, ErrorKind::io);
  EXPECT_THAT(none.error().message, HasSubstr("'/nowhere/at all' cannot be started: No such file"));
}

TEST(Process, ShellsReadWordsBack) {
  const std::vector<std::string> words{"plain", "two words", "it's", "a\nb", "$HOME `x` \"q\" \\", "", "*"};
  std::vector<std::string> line{"printf", "%s|"};
  line.insert(line.end(), words.begin(), words.end());
  const auto end = shell(shell_line(line));
  ASSERT_TRUE(end);
  std::string expected;
  for (const auto& word : words) expected += word + "|";
  EXPECT_EQ(end->out, expected);
}

}  // namespace
}  // namespace afterglow
