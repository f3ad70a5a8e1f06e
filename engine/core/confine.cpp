// SPDX-License-Identifier: MIT
#include "core/confine.h"

#include <fmt/format.h>

#if defined(__linux__) && __has_include(<linux/landlock.h>) && (defined(__x86_64__) || defined(__aarch64__))
#define AFTERGLOW_CONFINES 1
#include <fcntl.h>
#include <linux/landlock.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <iterator>

#include "core/confine_calls.h"
#include "core/file_descriptor.h"
#endif

namespace afterglow {

#ifndef AFTERGLOW_CONFINES

Result<void> confine(const Confinement&) {
  return Error{ErrorKind::device, "this system cannot confine a process (Landlock, from Linux 5.13 on)"};
}

#else
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kList = LANDLOCK_ACCESS_FS_READ_DIR, kRead = LANDLOCK_ACCESS_FS_READ_FILE,
                        kExecute = LANDLOCK_ACCESS_FS_EXECUTE, kWriteFile = LANDLOCK_ACCESS_FS_WRITE_FILE;
constexpr std::uint64_t kTruncate = 1ull << 14;  // LANDLOCK_ACCESS_FS_TRUNCATE, from the third version on
constexpr std::uint64_t kChange = LANDLOCK_ACCESS_FS_REMOVE_DIR | LANDLOCK_ACCESS_FS_REMOVE_FILE |
                                  LANDLOCK_ACCESS_FS_MAKE_DIR | LANDLOCK_ACCESS_FS_MAKE_REG;
/// All that Landlock's first version knows: what is not in a rule is forbidden.
constexpr std::uint64_t kFirstVersion = LANDLOCK_ACCESS_FS_MAKE_SYM * 2 - 1;
constexpr std::uint64_t kOfFiles = kRead | kExecute | kWriteFile | kTruncate;

Error failed(const char* what) {
  return Error{ErrorKind::device,
               fmt::format("this kernel cannot confine a process: {}: {}", what, std::strerror(errno))};
}

class Rules {
 public:
  Rules(int version, int set) : handled_(handled(version)), set_(set) {}
  static std::uint64_t handled(int version) { return version >= 3 ? kFirstVersion | kTruncate : kFirstVersion; }

  Result<void> allow(const std::vector<fs::path>& paths, std::uint64_t access) const {
    for (const fs::path& path : paths) AFTERGLOW_CHECK(allow(path, access));
    return {};
  }

 private:
  Result<void> allow(const fs::path& path, std::uint64_t access) const {
    const FileDescriptor file(open(path.c_str(), O_PATH | O_CLOEXEC));
    struct stat status {};
    if (file.get() < 0 || fstat(file.get(), &status) != 0) return {};
    if (!S_ISDIR(status.st_mode)) access &= kOfFiles;
    const landlock_path_beneath_attr rule{.allowed_access = access & handled_, .parent_fd = file.get()};
    if (rule.allowed_access == 0) return {};
    if (syscall(SYS_landlock_add_rule, set_, LANDLOCK_RULE_PATH_BENEATH, &rule, 0) != 0)
      return failed("a rule of Landlock");
    return {};
  }
  std::uint64_t handled_;
  int set_;
};

Result<void> confine_files(const Confinement& left) {
  const long version = syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
  if (version < 1) return failed("Landlock");
  const landlock_ruleset_attr attributes{.handled_access_fs = Rules::handled(static_cast<int>(version))};
  const FileDescriptor set(static_cast<int>(syscall(SYS_landlock_create_ruleset, &attributes, sizeof attributes, 0)));
  if (set.get() < 0) return failed("a set of Landlock's rules");
  const Rules rules(static_cast<int>(version), set.get());
  AFTERGLOW_CHECK(rules.allow(left.list, kList));
  AFTERGLOW_CHECK(rules.allow(left.read, kList | kRead));
  AFTERGLOW_CHECK(rules.allow(left.execute, kList | kRead | kExecute));
  AFTERGLOW_CHECK(rules.allow(left.write, kList | kRead | kWriteFile | kTruncate | kChange));
  AFTERGLOW_CHECK(rules.allow(left.devices, kList | kRead | kWriteFile));
  if (syscall(SYS_landlock_restrict_self, set.get(), 0) != 0) return failed("Landlock");
  return {};
}

}  // namespace

Result<void> confine(const Confinement& left) {
  std::error_code ec;
  const auto threads = std::distance(fs::directory_iterator("/proc/self/task", ec), fs::directory_iterator());
  if (!ec && threads > 1) return Error{ErrorKind::other, "a process with threads cannot be confined"};
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return failed("no_new_privs");
  AFTERGLOW_CHECK(confine_files(left));
  return confine_calls();
}

#endif

}  // namespace afterglow
