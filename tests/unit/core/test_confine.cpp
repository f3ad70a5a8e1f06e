// SPDX-License-Identifier: MIT
// What a confined process can no longer do, each tried by one. A kernel without Landlock says so.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <functional>
#include <thread>

#include "core/confine.h"

namespace afterglow {
namespace {

namespace fs = std::filesystem;

class Confine : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / ("afterglow_confine_" + std::to_string(getpid()));
    for (const char* name : {"mine", "other", "out"}) fs::create_directories(folder_ / name);
    for (const char* name : {"mine/a", "other/b", "out/c"}) std::ofstream(folder_ / name) << "text";
  }
  void TearDown() override { fs::remove_all(folder_); }

  enum Code { kYes = 10, kNo, kLacking, kFailed };
  /// Whether `attempt` succeeds in a process that may read mine/ and write out/.
  Code confined(const std::function<bool()>& attempt) const {
    const pid_t child = fork();
    if (child == 0) {
      const auto done =
          confine({.list = {}, .read = {folder_ / "mine"}, .execute = {}, .write = {folder_ / "out"}, .devices = {}});
      if (!done) _exit(done.error().kind == ErrorKind::device ? kLacking : kFailed);
      _exit(attempt() ? kYes : kNo);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? static_cast<Code>(WEXITSTATUS(status)) : kFailed;
  }
  bool opens(const std::string& name, int flags) const { return open((folder_ / name).c_str(), flags, 0600) >= 0; }
  static bool runs_a_program() {
    const char* const arguments[] = {"/bin/true", nullptr};
    execv("/bin/true", const_cast<char* const*>(arguments));
    return false;  // else there is another program here, which ends with 0
  }
  fs::path folder_;
};

TEST_F(Confine, LeavesWhatItSaysAndNothingElse) {
  if (confined([] { return true; }) == kLacking) GTEST_SKIP() << "this kernel has no Landlock";
  EXPECT_EQ(confined([&] { return opens("mine/a", O_RDONLY); }), kYes);
  EXPECT_EQ(confined([&] { return opens("mine/a", O_RDWR); }), kNo);
  EXPECT_EQ(confined([&] { return opens("mine/new", O_CREAT | O_WRONLY); }), kNo);
  EXPECT_EQ(confined([&] { return opens("other/b", O_RDONLY); }), kNo);
  EXPECT_EQ(confined([&] { return opens("mine/../other/b", O_RDONLY); }), kNo);
  EXPECT_EQ(confined([&] { return opens("out/new", O_CREAT | O_WRONLY); }), kYes);
  EXPECT_EQ(confined([&] { return rename((folder_ / "out/c").c_str(), (folder_ / "out/d").c_str()) == 0; }), kYes);
  EXPECT_EQ(confined([&] { return symlink("/etc/passwd", (folder_ / "out/link").c_str()) == 0; }), kNo);
  EXPECT_EQ(confined([] { return open("/etc/passwd", O_RDONLY) >= 0; }), kNo);
  EXPECT_EQ(confined([] { return socket(AF_INET, SOCK_STREAM, 0) >= 0; }), kNo);
  EXPECT_EQ(confined([] { return socket(AF_UNIX, SOCK_STREAM, 0) >= 0; }), kNo);
  EXPECT_EQ(confined(runs_a_program), kNo);
  EXPECT_EQ(confined([&] {
              bool opened = false;
              std::thread([&] { opened = opens("other/b", O_RDONLY); }).join();
              return opened;
            }),
            kNo)
      << "threads that begin later are confined, too";
}

TEST_F(Confine, ThreadsThatAreThereAreRefused) {
  const pid_t child = fork();
  if (child == 0) {
    std::thread([] { pause(); }).detach();
    const auto done = confine({});
    _exit(!done && done.error().kind != ErrorKind::io ? kNo : kYes);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), kNo);
}

}  // namespace
}  // namespace afterglow
