// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <mutex>

#include "core/file.h"
#include "core/gathering.h"
#include "core/watch.h"
#include "core/watch_places.h"

namespace afterglow {
namespace {
namespace fs = std::filesystem;
using namespace std::chrono_literals;

// ---- when to act: no real time

Gathering::Time at(std::chrono::milliseconds since_start) { return Gathering::Time{} + since_start; }

TEST(Gathering, ActsFiveMillisecondsAfterTheFirstWholeFile) {
  Gathering signs;
  EXPECT_FALSE(signs.due());
  signs.whole(at(100ms));
  signs.whole(at(104ms));
  EXPECT_EQ(signs.due(), at(105ms));
  EXPECT_EQ(signs.take(), at(100ms));
  EXPECT_FALSE(signs.due());
}

TEST(Gathering, WaitsForAFileThatIsBeingWritten) {
  Gathering signs;
  signs.writing(at(0ms));
  signs.writing(at(60ms));
  EXPECT_EQ(signs.due(), at(160ms));
  signs.whole(at(70ms));
  EXPECT_EQ(signs.due(), at(75ms)) << "closed: whole";
  signs.writing(at(72ms));
  EXPECT_EQ(signs.due(), at(75ms)) << "another file does not hold back the one that is whole";
  EXPECT_EQ(signs.take(), at(0ms));
}

TEST(Gathering, DoesNotWaitForeverForAWriter) {
  Gathering signs;
  for (auto now = 0ms; now <= 990ms; now += 10ms) signs.writing(at(now));
  EXPECT_EQ(signs.due(), at(1000ms));
  signs.take();
  signs.writing(at(2000ms));
  EXPECT_EQ(signs.due(), at(2100ms));
}

// ---- real files

class Watch : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / ("afterglow_watch_" + std::string(test->name()) + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override {
    watcher_.reset();
    fs::remove_all(folder_);
  }

  static void write(const fs::path& file, const std::string& text) {
    fs::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
  }

  void watch(const std::vector<fs::path>& paths, const WatchOptions& options = {}) {
    watcher_ = std::make_unique<Watcher>(options, [this](auto, bool) {
      const std::lock_guard lock(mutex_);
      ++probes_;
      changed_.notify_all();
    });
    watcher_->watch(paths);
    forget();
  }
  void forget() {
    const std::lock_guard lock(mutex_);
    probes_ = 0;
  }
  /// Whether a look came since the last call; waits for it.
  bool looked() {
    std::unique_lock lock(mutex_);
    const bool came = changed_.wait_for(lock, 30s, [&] { return probes_ > 0; });
    probes_ = 0;
    return came;
  }

  fs::path folder_;
  std::unique_ptr<Watcher> watcher_;
  std::mutex mutex_;
  std::condition_variable changed_;
  int probes_ = 0;
};

/// Then nothing can wake it: it looks again and again, and ends.
TEST_F(Watch, WithoutAnEventOfItsOwnItPolls) {
  watch({folder_ / "look.lua"});  // UBSan wants a file for each type that it meets first
  watcher_.reset();
  forget();
  const int next = open("/dev/null", O_RDONLY);
  ASSERT_GE(next, 0);
  close(next);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
  rlimit one_more = before;
  one_more.rlim_cur = static_cast<rlim_t>(next) + 1;  // inotify takes it
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &one_more), 0);
  watch({folder_ / "look.lua"});
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
  EXPECT_EQ(watcher_->method().substr(0, 7), "polling");
  write(folder_ / "look.lua", "one");
  EXPECT_TRUE(looked());
  watcher_.reset();
}

TEST_F(Watch, SeesEachWayOfSaving) {
  const fs::path file = folder_ / "look.lua", other = folder_ / "look.lua~";
  write(file, "one");
  watch({file});
  EXPECT_EQ(watcher_->method(), "inotify");

  write(file, "two");  // truncates and writes
  EXPECT_TRUE(looked());

  const int in_place = open(file.c_str(), O_WRONLY);
  ASSERT_EQ(pwrite(in_place, "x", 1, 0), 1);
  EXPECT_TRUE(looked()) << "still open";
  close(in_place);
  EXPECT_TRUE(looked()) << "closed";

  write(other, "three");
  fs::rename(other, file);
  EXPECT_TRUE(looked()) << "renamed over";

  fs::rename(file, other);
  EXPECT_TRUE(looked()) << "moved away";
  write(file, "four");
  EXPECT_TRUE(looked()) << "and made anew";

  fs::remove(file);
  EXPECT_TRUE(looked()) << "removed";
  fs::create_hard_link(other, file);
  EXPECT_TRUE(looked()) << "linked";
  fs::remove(file);
  EXPECT_TRUE(looked());
  fs::create_symlink(other, file);
  EXPECT_TRUE(looked()) << "a link";
}

TEST_F(Watch, DoesNotCareAboutOtherFiles) {
  const fs::path file = folder_ / "look.lua";
  write(file, "one");
  watch({file});
  for (int i = 0; i < 100; ++i) write(folder_ / ("frame" + std::to_string(i) + ".png"), "pixels");
  write(file, "two");
  EXPECT_TRUE(looked());
  const std::lock_guard lock(mutex_);
  EXPECT_LT(probes_, 5) << "a hundred others, and one that counts";
}

TEST_F(Watch, SeesWhatAppearsHoweverDeep) {
  const fs::path file = folder_ / "a" / "b" / "c.glsl";
  watch({file});
  fs::create_directory(folder_ / "a");
  EXPECT_TRUE(looked());
  fs::create_directory(folder_ / "a" / "b");
  EXPECT_TRUE(looked());
  write(file, "one");
  EXPECT_TRUE(looked());
  write(file, "two");
  EXPECT_TRUE(looked());

  // All at once: the folders are not watched yet when the file is written.
  fs::remove_all(folder_ / "a");
  EXPECT_TRUE(looked());
  for (int i = 0; i < 50; ++i) {
    write(file, "three");
    forget();
    const auto text = read_file(file);
    if (!text) ADD_FAILURE();
    write(file, "four");
    EXPECT_TRUE(looked());
    fs::remove_all(folder_ / "a");
    EXPECT_TRUE(looked());
  }
}

TEST_F(Watch, FollowsFoldersThatMove) {
  const fs::path file = folder_ / "show" / "looks" / "look.lua";
  write(file, "one");
  watch({file});
  fs::rename(folder_ / "show", folder_ / "hidden");
  EXPECT_TRUE(looked());
  write(folder_ / "hidden" / "looks" / "look.lua", "elsewhere");
  fs::rename(folder_ / "hidden", folder_ / "show");
  EXPECT_TRUE(looked());
  write(file, "two");
  EXPECT_TRUE(looked()) << "back where it was";

  write(folder_ / "new" / "looks" / "look.lua", "three");  // another folder takes its place
  fs::rename(folder_ / "show", folder_ / "old");
  fs::rename(folder_ / "new", folder_ / "show");
  EXPECT_TRUE(looked());
  write(file, "four");
  EXPECT_TRUE(looked()) << "the new one is watched";
}

TEST_F(Watch, FollowsLinksAtEachStep) {
  write(folder_ / "v1" / "look.lua", "one");
  write(folder_ / "v2" / "look.lua", "two");
  fs::create_directory_symlink("v1", folder_ / "current");
  fs::create_symlink("current/look.lua", folder_ / "look.lua");
  watch({folder_ / "look.lua"});
  write(folder_ / "v1" / "look.lua", "three");
  EXPECT_TRUE(looked()) << "the file behind the links";
  fs::create_directory_symlink("v2", folder_ / "next");
  fs::rename(folder_ / "next", folder_ / "current");
  EXPECT_TRUE(looked()) << "a link on the way";
  write(folder_ / "v2" / "look.lua", "four");
  EXPECT_TRUE(looked()) << "the file it leads to now";
}

TEST_F(Watch, SeesAnyNameInAFolder) {
  watch({folder_ / "packs" / ""});
  fs::create_directory(folder_ / "packs");
  EXPECT_TRUE(looked());
  write(folder_ / "packs" / "film.zip", "PK");
  EXPECT_TRUE(looked());
}

TEST_F(Watch, LooksAgainWhenEventsWereLost) {
  // The queue runs over while the watcher is held up in a look.
  const fs::path file = folder_ / "look.lua", noise = folder_ / "noise";
  write(file, "one");
  std::size_t most = 16384;
  std::ifstream("/proc/sys/fs/inotify/max_queued_events") >> most;
  std::mutex gate;
  std::condition_variable opened;
  bool held = false, open_now = false;
  int looks = 0;
  Watcher watcher({}, [&](auto, bool) {
    std::unique_lock lock(gate);
    ++looks;
    held = true;
    opened.notify_all();
    opened.wait(lock, [&] { return open_now; });
  });
  watcher.watch({file});
  write(file, "two");
  {
    std::unique_lock lock(gate);
    ASSERT_TRUE(opened.wait_for(lock, 30s, [&] { return held; }));
  }
  for (std::size_t i = 0; i <= most / 2; ++i) {
    const int made = open(noise.c_str(), O_CREAT | O_WRONLY, 0600);
    close(made);
    unlink(noise.c_str());
  }
  write(file, "three");  // of this one there is no event any more
  std::unique_lock lock(gate);
  const int before = looks;
  open_now = true;
  opened.notify_all();
  EXPECT_TRUE(opened.wait_for(lock, 30s, [&] { return looks > before; }));
}

TEST_F(Watch, PollsWhenToldSo) {
  const fs::path file = folder_ / "look.lua";
  write(file, "one");
  watch({file}, {.poll = true, .interval = 1ms});
  EXPECT_EQ(watcher_->method(), "polling every 1 ms: asked for");
  EXPECT_TRUE(looked());
  EXPECT_TRUE(looked());
}

TEST_F(Watch, ChangesOfWhatIsWatchedTakeEffect) {
  const fs::path first = folder_ / "first", second = folder_ / "second";
  write(first, "one");
  write(second, "one");
  watch({first});
  watcher_->watch({second});
  write(first, "two");
  write(second, "two");
  EXPECT_TRUE(looked());
  watcher_->watch({first, second});
  write(first, "three");
  EXPECT_TRUE(looked());
}

TEST(WatchPlaces, AreTheStepsOfThePath) {
  const fs::path folder = fs::temp_directory_path() / ("afterglow_places_" + std::to_string(getpid()));
  fs::create_directories(folder / "real");
  fs::create_directory_symlink("real", folder / "link");
  std::ofstream(folder / "real" / "file") << "x";
  const auto places = watch_places(folder / "link" / ".." / "link" / "file");
  EXPECT_TRUE(places.contains({folder.string(), "link", false}));
  EXPECT_TRUE(places.contains({folder.string(), "real", false}));
  EXPECT_TRUE(places.contains({(folder / "real").string(), "file", true}));
  EXPECT_FALSE(places.contains({(folder / "link").string(), "file", true})) << "a folder behind a link has one name";
  const auto missing = watch_places(folder / "none" / "file");
  EXPECT_TRUE(missing.contains({folder.string(), "none", false}));
  EXPECT_FALSE(missing.contains({(folder / "none").string(), "file", true}));
  fs::create_symlink("loop", folder / "loop");
  EXPECT_FALSE(watch_places(folder / "loop" / "file").empty()) << "ends";
  fs::remove_all(folder);
}

}  // namespace
}  // namespace afterglow
