// SPDX-License-Identifier: MIT
// What a confined process can no longer do, each tried by one. A kernel without Landlock says so.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/fs.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/ipc.h>
#include <sys/mman.h>
#include <sys/msg.h>
#include <sys/resource.h>
#include <sys/sem.h>
#include <sys/shm.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <sys/xattr.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
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

/// Why a call failed; 0 if it did not.
int reason(long result) { return result < 0 ? errno : 0; }

TEST_F(Confine, FilesAreNotChangedByTheirNames) {
  if (confined([] { return true; }) == kLacking) GTEST_SKIP() << "this kernel has no Landlock";
  const std::string file = (folder_ / "mine/a").string();
  const char* const name = file.c_str();
  const timespec times[2] = {{1, 0}, {1, 0}};
  EXPECT_EQ(confined([&] { return chmod(name, 0777) == 0; }), kNo);
  EXPECT_EQ(confined([&] { return fchmodat(AT_FDCWD, name, 0777, 0) == 0; }), kNo);
  EXPECT_EQ(confined([&] { return chown(name, getuid(), getgid()) == 0; }), kNo);
  EXPECT_EQ(confined([&] { return lchown(name, getuid(), getgid()) == 0; }), kNo);
  EXPECT_EQ(confined([&] { return fchownat(AT_FDCWD, name, getuid(), getgid(), 0) == 0; }), kNo);
  EXPECT_EQ(confined([&] { return utimensat(AT_FDCWD, name, times, 0) == 0; }), kNo);
  EXPECT_EQ(confined([&] { return truncate(name, 0) == 0; }), kNo);
  EXPECT_EQ(confined([&] { return open(name, O_RDONLY | O_TRUNC) >= 0; }), kNo);
  EXPECT_EQ(confined([&] { return reason(setxattr(name, "user.x", "1", 1, 0)) != EPERM; }), kNo);
  EXPECT_EQ(confined([&] {
              const int flags = 0;
              return reason(ioctl(open(name, O_RDONLY), FS_IOC_SETFLAGS, &flags)) != EPERM;
            }),
            kNo);
  EXPECT_EQ(fs::file_size(name), 4u);
  // What is open keeps the mode that it gets.
  EXPECT_EQ(confined([&] {
              const int out = open((folder_ / "out/new").c_str(), O_CREAT | O_WRONLY, 0600);
              return fchmod(out, 0644) == 0 && ftruncate(out, 9) == 0;
            }),
            kYes);
}

TEST_F(Confine, OtherProcessesAreOutOfReach) {
  if (confined([] { return true; }) == kLacking) GTEST_SKIP() << "this kernel has no Landlock";
  const pid_t other = getpid();  // of the process that is confined the parent
  EXPECT_EQ(confined([&] { return kill(other, SIGURG) == 0; }), kNo);
  EXPECT_EQ(confined([&] { return kill(0, SIGURG) == 0; }), kNo);
  EXPECT_EQ(confined([&] { return syscall(SYS_tgkill, other, other, SIGURG) == 0; }), kNo);
  EXPECT_EQ(confined([&] { return syscall(SYS_kill, other | 1l << 32, SIGURG) == 0; }), kNo);
  EXPECT_EQ(confined([&] { return syscall(SYS_pidfd_open, other, 0) >= 0; }), kNo);
  EXPECT_EQ(confined([&] { return prlimit(other, RLIMIT_NOFILE, nullptr, nullptr) == 0; }), kNo);
  EXPECT_EQ(confined([&] { return fcntl(0, F_SETOWN, other) == 0; }), kNo);
  EXPECT_EQ(confined([] { return shmget(IPC_PRIVATE, 4096, IPC_CREAT | 0600) >= 0; }), kNo);
  EXPECT_EQ(confined([] { return semget(IPC_PRIVATE, 1, IPC_CREAT | 0600) >= 0; }), kNo);
  EXPECT_EQ(confined([] { return msgget(IPC_PRIVATE, IPC_CREAT | 0600) >= 0; }), kNo);
  EXPECT_EQ(confined([] { return reason(syscall(SYS_mq_open, "afterglow", O_CREAT | O_RDWR, 0600, 0)) != EPERM; }),
            kNo);
  EXPECT_EQ(confined([] { return reason(syscall(SYS_clone, CLONE_NEWUSER | SIGCHLD, 0, 0, 0, 0)) != EPERM; }), kNo);
  for (const unsigned long request : {0ul + TIOCSTI, 0ul + TIOCLINUX, 1ul << 32 | TIOCSTI})
    EXPECT_EQ(confined([&] { return reason(syscall(SYS_ioctl, 0, request, "x")) != EPERM; }), kNo) << request;
}

TEST_F(Confine, AProcessKeepsItself) {
  if (confined([] { return true; }) == kLacking) GTEST_SKIP() << "this kernel has no Landlock";
  EXPECT_EQ(confined([] { return kill(getpid(), SIGURG) == 0 && raise(SIGURG) == 0; }), kYes);
  EXPECT_EQ(confined([] { return kill(getppid(), 0) == 0; }), kYes) << "only asks whether it is there";
  EXPECT_EQ(confined([] {
              rlimit limit{};
              return getrlimit(RLIMIT_NOFILE, &limit) == 0 && setpriority(PRIO_PROCESS, 0, 19) == 0;
            }),
            kYes);
  EXPECT_EQ(confined([] { return memfd_create("x", MFD_CLOEXEC) >= 0; }), kYes);
  const pid_t child = fork();
  if (child == 0) {
    (void)confine({});
    abort();
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGABRT) << status;
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
