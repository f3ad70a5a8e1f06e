// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/capability.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <functional>
#include <set>
#include <string>
#include <thread>

#include "core/file.h"
#include "core/replace_file.h"
#include "core/temporary.h"

namespace afterglow {
namespace {
namespace fs = std::filesystem;

class Temporaries : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "afterglow-temporary-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_)) names.insert(entry.path().filename().string());
    return names;
  }
  void touch(const fs::path& file) const { std::ofstream(file) << "half"; }

  fs::path folder_;
};

TEST_F(Temporaries, NamesAreHiddenUniqueAndKeepTheExtension) {
  const fs::path a = temporary_beside(folder_ / "shot.0001.exr"), b = temporary_beside(folder_ / "shot.0001.exr");
  EXPECT_NE(a, b);
  EXPECT_EQ(a.parent_path(), folder_);
  EXPECT_EQ(a.extension(), ".exr");
  EXPECT_TRUE(a.filename().string().starts_with(".shot.0001."));
}

TEST_F(Temporaries, WhatIsNotCommittedIsGone) {
  {
    Temporary file(folder_ / "shot.exr"), folder(folder_ / "pack"), never(folder_ / "never.exr");
    touch(file.path());
    fs::create_directories(folder.path() / "effects");
    touch(folder.path() / "effects" / "glow.lua");
    EXPECT_EQ(files().size(), 2u);
  }
  EXPECT_EQ(files(), std::set<std::string>());
}

TEST_F(Temporaries, WhatIsCommittedHasItsNameAndStays) {
  {
    Temporary file(folder_ / "shot.exr");
    touch(file.path());
    EXPECT_TRUE(file.commit());
  }
  EXPECT_EQ(files(), std::set<std::string>{"shot.exr"});
}

TEST_F(Temporaries, ALinkStaysAndWhatItLeadsToBecomesAnother) {
  fs::create_directory(folder_ / "store");
  std::ofstream(folder_ / "store/real.txt") << "old";
  fs::create_symlink("store/real.txt", folder_ / "link.txt");
  ASSERT_TRUE(write_file_atomically(folder_ / "link.txt", "new"));
  EXPECT_TRUE(fs::is_symlink(folder_ / "link.txt"));
  EXPECT_EQ(read_file(folder_ / "store/real.txt").value(), "new");
  EXPECT_EQ(behind_links(folder_ / "link.txt"), folder_ / "store/real.txt");
  EXPECT_EQ(behind_links(folder_ / "none.txt"), folder_ / "none.txt");
}

TEST_F(Temporaries, ALinkToWhatIsNotThereStaysAndItIsMade) {
  fs::create_directory(folder_ / "store");
  fs::create_symlink("store/again.txt", folder_ / "link.txt");
  fs::create_symlink(folder_ / "store/real.txt", folder_ / "store/again.txt");
  ASSERT_TRUE(write_file_atomically(folder_ / "link.txt", "new"));
  EXPECT_TRUE(fs::is_symlink(folder_ / "link.txt"));
  EXPECT_TRUE(fs::is_symlink(folder_ / "store/again.txt"));
  EXPECT_EQ(read_file(folder_ / "store/real.txt").value(), "new");
}

TEST_F(Temporaries, LinksThatLeadToEachOtherStayAndAreAnError) {
  fs::create_symlink("b.txt", folder_ / "a.txt");
  fs::create_symlink("a.txt", folder_ / "b.txt");
  const auto written = write_file_atomically(folder_ / "a.txt", "new");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().message, "cannot be written: Too many levels of symbolic links");
  EXPECT_EQ(files(), (std::set<std::string>{"a.txt", "b.txt"}));
}

TEST_F(Temporaries, NamesAsLongAsTheyMayBeCanBeWritten) {
  std::string longest;
  while (longest.size() + 3 <= 251) longest += "\xE2\x82\xAC";  // €
  for (const std::string& name : {longest + ".exr", std::string(255, 'x'), "a." + std::string(253, 'y')}) {
    ASSERT_TRUE(write_file_atomically(folder_ / name, "new")) << name;
    EXPECT_EQ(read_file(folder_ / name).value(), "new");
    const std::string beside = temporary_beside(folder_ / name).filename().string();
    EXPECT_LE(beside.size(), 143u) << "what encrypted file systems take";
    EXPECT_NE(beside, temporary_beside(folder_ / name).filename().string());
  }
  const std::string beside = temporary_beside(folder_ / (longest + ".exr")).filename().string();
  EXPECT_NE(beside.find("\xE2\x82\xAC." + temporary_mark()), std::string::npos) << "no part of a character";
  touch(folder_ / beside);
  EXPECT_EQ(remove_temporaries_of(temporary_mark(), folder_), 0) << "this process lives";
}

/// Calls it as somebody whom modes of files bind, root or not.
void without_override(const std::function<void()>& call) {
  std::thread([&] {
    __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
    std::array<__user_cap_data_struct, 2> data{};
    syscall(SYS_capget, &header, data.data());
    constexpr unsigned kOverrides = 1u << CAP_DAC_OVERRIDE | 1u << CAP_DAC_READ_SEARCH;
    data[0].effective &= ~kOverrides;
    data[0].permitted &= ~kOverrides;
    syscall(SYS_capset, &header, data.data());
    call();
  }).join();
}

TEST_F(Temporaries, WhatMayNotBeWrittenIsNotReplaced) {
  const fs::path file = folder_ / "shot.txt";
  std::ofstream(file) << "old";
  fs::permissions(file, fs::perms::owner_read);
  without_override([&] {
    EXPECT_TRUE(check_replaceable(folder_ / "none.txt"));
    EXPECT_FALSE(check_replaceable(file));
    const auto written = write_file_atomically(file, "new");
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().kind, ErrorKind::io);
    EXPECT_EQ(written.error().message, "cannot be written: Permission denied");
  });
  EXPECT_EQ(read_file(file).value(), "old");
  EXPECT_EQ(files(), std::set<std::string>{"shot.txt"});
}

TEST_F(Temporaries, WhatRootSavesStaysItsOwners) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can give files away";
  constexpr uid_t kOther = 4321;
  const fs::path file = folder_ / "look.lua";
  std::ofstream(file) << "old";
  ASSERT_EQ(chown(file.c_str(), kOther, kOther), 0);
  ASSERT_TRUE(replace_file_atomically(file, "new"));
  struct stat status {};
  ASSERT_EQ(stat(file.c_str(), &status), 0);
  EXPECT_EQ(status.st_uid, kOther);
  EXPECT_EQ(status.st_gid, kOther);
}

TEST_F(Temporaries, FilesThatCannotBeSeenAreNotCalledMissing) {
  fs::create_directory(folder_ / "closed");
  touch(folder_ / "closed/x.lua");
  fs::permissions(folder_ / "closed", fs::perms::none);
  without_override([&] {
    EXPECT_EQ(read_named_file(folder_ / "closed/x.lua").error().message, "cannot be read: Permission denied");
    EXPECT_EQ(missing_file(folder_ / "closed/x.lua").message, "cannot be read: Permission denied");
  });
  fs::permissions(folder_ / "closed", fs::perms::owner_all);
}

TEST_F(Temporaries, PermissionsStayThoseOfTheFileThatWasThere) {
  const fs::path file = folder_ / "report.json";
  std::ofstream(file) << "old";
  fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
  ASSERT_TRUE(write_file_atomically(file, "new"));
  EXPECT_EQ(fs::status(file).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(Temporaries, PipesAreWrittenToAsTheyStand) {
  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const auto unread = write_file_atomically(pipe, "a report");
  ASSERT_FALSE(unread);
  EXPECT_EQ(unread.error().message, "cannot be written: nobody reads it");
  const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  EXPECT_TRUE(write_file_atomically(pipe, "a report"));
  std::array<char, 64> text{};
  EXPECT_EQ(read(reader, text.data(), text.size()), 8);
  EXPECT_STREQ(text.data(), "a report");
  close(reader);
  EXPECT_TRUE(fs::is_fifo(pipe));
  const auto full = write_file_atomically("/dev/full", "a report");
  ASSERT_FALSE(full);
  EXPECT_EQ(full.error().message, "cannot be written: No space left on device");
}

TEST_F(Temporaries, WhatCannotBeCommittedIsGoneAndSaid) {
  fs::create_directories(folder_ / "shot.exr" / "full");
  {
    Temporary file(folder_ / "shot.exr");
    touch(file.path());
    const auto done = file.commit();
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().file, (folder_ / "shot.exr").string());
  }
  EXPECT_EQ(files(), std::set<std::string>{"shot.exr"});
}

TEST_F(Temporaries, ThoseOfDeadProcessesAreRemovedAndNoOthers) {
  const fs::path alive = temporary_beside(folder_ / "alive.exr");
  touch(alive);
  const pid_t child = fork();
  if (child == 0) {
    touch(temporary_beside(folder_ / "dead.0001.exr"));
    touch(temporary_beside(folder_ / "dead.png.made"));
    _exit(0);
  }
  ASSERT_EQ(waitpid(child, nullptr, 0), child);
  const std::string number = std::to_string(child);
  // Names that are somebody else's: of another machine, not hidden, not whole.
  const std::string theirs[] = {".x.00000000-" + number + "-0.tmp.exr", "x.tmp.exr", ".x.tmp", ".tmp",
                                alive.filename().string().substr(1)};
  for (const auto& name : theirs) touch(folder_ / name);
  EXPECT_EQ(files().size(), 8u);
  EXPECT_EQ(remove_abandoned_temporaries(folder_), 2);
  std::set<std::string> left(std::begin(theirs), std::end(theirs));
  left.insert(alive.filename().string());
  EXPECT_EQ(files(), left);
  EXPECT_EQ(remove_abandoned_temporaries(folder_ / "missing"), 0);
}

/// Killed, and nobody has asked after it yet.
TEST_F(Temporaries, ThoseOfZombiesAreRemoved) {
  const pid_t child = fork();
  if (child == 0) {
    touch(temporary_beside(folder_ / "dead.exr"));
    _exit(0);
  }
  siginfo_t ended{};
  ASSERT_EQ(waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOWAIT), 0);
  EXPECT_EQ(files().size(), 1u);
  EXPECT_EQ(remove_abandoned_temporaries(folder_), 1);
  EXPECT_TRUE(files().empty());
  ASSERT_EQ(waitpid(child, nullptr, 0), child);
}

}  // namespace
}  // namespace afterglow
