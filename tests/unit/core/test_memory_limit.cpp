// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <tuple>

#include "core/memory_limit.h"

namespace afterglow {
namespace {
namespace fs = std::filesystem;

constexpr std::uint64_t kMiB = 1ull << 20;

/// A machine of 64 GiB whose files lie in a folder.
class MemoryLimits : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "afterglow-memory-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    root_ = pattern;
    put("proc/meminfo", "MemTotal:       67108864 kB\nMemFree:         1048576 kB\n");
  }
  void TearDown() override { fs::remove_all(root_); }
  void put(const fs::path& file, const std::string& text) const {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text;
  }
  MemoryLimit limit() const { return usual_memory_limit(root_); }

  fs::path root_;
};

TEST_F(MemoryLimits, LargeMachinesHaveTheUsualOne) {
  EXPECT_EQ(limit().bytes, 6144 * kMiB);
  EXPECT_EQ(limit().of, "");
  EXPECT_EQ(usual_memory_limit(root_ / "nothing").bytes, 6144 * kMiB);
}

TEST_F(MemoryLimits, SmallMachinesHaveTheirs) {
  put("proc/meminfo", "MemFree:         1048576 kB\nMemTotal:        2097152 kB\n");
  EXPECT_EQ(limit().bytes, 2048 * kMiB);
  EXPECT_EQ(limit().of, "what this machine has");
}

TEST_F(MemoryLimits, TheLeastOfAGroupAndThoseAboveItCounts) {
  put("proc/self/cgroup", "0::/jobs/17/step\n");
  put("sys/fs/cgroup/jobs/17/step/memory.max", "max\n");
  EXPECT_EQ(limit().of, "");
  put("sys/fs/cgroup/jobs/17/memory.max", "1073741824\n");
  put("sys/fs/cgroup/jobs/memory.max", "4294967296\n");
  EXPECT_EQ(limit().bytes, 1024 * kMiB);
  EXPECT_EQ(limit().of, "what the control group /jobs/17 may take");
}

TEST_F(MemoryLimits, GroupsOfTheFirstVersionCountToo) {
  put("proc/self/cgroup", "5:cpu,cpuacct:/docker/ab12\n4:memory:/docker/ab12\n0::/\n");
  put("sys/fs/cgroup/memory/memory.limit_in_bytes", "536870912\n");  // a container sees its own as the topmost one
  EXPECT_EQ(limit().bytes, 512 * kMiB);
  EXPECT_EQ(limit().of, "what the control group / may take");
  put("sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n");
  EXPECT_EQ(limit().of, "");
}

TEST(MemoryLimit, WhatIsMoreReadsAsMore) {
  for (const auto& [allowed, told, next] :
       {std::tuple{2 * kMiB + kMiB / 3, "2 MiB", "3 MiB"}, std::tuple{6 * 1024 * kMiB, "6.0 GiB", "6.1 GiB"},
        std::tuple{700 * std::uint64_t{1024} + 7, "700 KiB", "701 KiB"},
        std::tuple{std::uint64_t{12}, "12 bytes", "13 bytes"}}) {
    EXPECT_EQ(allowed_memory(allowed), std::string(told) + " allowed (--max-memory)");
    EXPECT_EQ(needed_memory(allowed + 1), next);
  }
}

TEST(MemoryLimit, MessagesNameTheOption) {
  EXPECT_EQ(allowed_memory(256 * kMiB + 4096), "256 MiB allowed (--max-memory)");
}

}  // namespace
}  // namespace afterglow
