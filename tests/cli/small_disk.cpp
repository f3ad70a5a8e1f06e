// SPDX-License-Identifier: MIT
#include "small_disk.h"

#include <fmt/format.h>
#include <sched.h>
#include <sys/mount.h>
#include <unistd.h>

#include <fstream>

namespace afterglow::test {
namespace {

bool enter_namespace() {
  const uid_t user = getuid();
  const gid_t group = getgid();
  if (unshare(CLONE_NEWNS) != 0) {
    if (unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) return false;
    std::ofstream("/proc/self/setgroups") << "deny";
    std::ofstream("/proc/self/uid_map") << fmt::format("0 {} 1", user);
    std::ofstream("/proc/self/gid_map") << fmt::format("0 {} 1", group);
  }
  // What is mounted stays in here. In a chroot, whose root is no mount, it is seen outside until it is taken away again.
  mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr);
  return true;
}

bool mount_tmpfs(const std::filesystem::path& folder, const std::string& size, unsigned long flags) {
  return mount("none", folder.c_str(), "tmpfs", flags, ("size=" + size).c_str()) == 0;
}

}  // namespace

SmallDisk::SmallDisk(std::filesystem::path folder, const std::string& size)
    : folder_(std::move(folder)), mounted_(enter_namespace() && mount_tmpfs(folder_, size, 0)) {}

SmallDisk::~SmallDisk() {
  if (mounted_) umount2(folder_.c_str(), MNT_DETACH);  // somebody may still look at it
}

bool SmallDisk::resize(const std::string& size) const { return mount_tmpfs(folder_, size, MS_REMOUNT); }

}  // namespace afterglow::test
