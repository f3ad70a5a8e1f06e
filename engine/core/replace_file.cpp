// SPDX-License-Identifier: MIT
#include "core/replace_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/file_descriptor.h"
#include "core/temporary.h"

namespace afterglow {
namespace fs = std::filesystem;
namespace {

// All of it, with owner and mode of `old`, on disk. On failure errno tells.
bool write_new(const fs::path& path, std::string_view content, const struct stat& old) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (file < 0) return false;
  bool good = write_all(file, content);
  // Root leaves the file its owner's; others cannot give files away. Before the mode: it takes bits of it.
  const bool given = good && fchown(file, old.st_uid, old.st_gid) == 0;
  static_cast<void>(given);
  good = good && fchmod(file, old.st_mode & 07777) == 0 && fsync(file) == 0;
  const int reason = errno;
  close(file);
  errno = reason;
  return good;
}

}  // namespace

Result<void> replace_file_atomically(const fs::path& path, std::string_view content,
                                     const std::function<Result<void>()>& last_look) {
  const auto failed = [&](int reason) {
    return Error{ErrorKind::io, fmt::format("cannot be written: {}", std::strerror(reason)), path.string()};
  };
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) return failed(errno);
  AFTERGLOW_CHECK(check_replaceable(path));
  Temporary temporary(path);
  if (!write_new(temporary.path(), content, status)) {
    const int reason = errno;
    return failed(reason);
  }
  if (last_look) AFTERGLOW_CHECK(last_look());
  return temporary.commit();
}

}  // namespace afterglow
