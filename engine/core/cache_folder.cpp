// SPDX-License-Identifier: MIT
#include "core/cache_folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <vector>

namespace afterglow {
namespace fs = std::filesystem;

Result<void> make_cache_folder(const fs::path& folder) {
  std::error_code why;
  fs::create_directories(folder, why);
  if (!why && access(folder.c_str(), W_OK | X_OK) != 0) why = {errno, std::system_category()};
  if (!why) return {};
  return Error{ErrorKind::io, fmt::format("the cache folder cannot be written to: {}", why.message()), folder.string()};
}

CacheTrim trim_cache(const fs::path& folder, const std::string& extension, const CacheLimits& limits,
                     fs::file_time_type now) {
  struct File {
    fs::path path;
    fs::file_time_type used;
    std::uint64_t bytes = 0;
  };
  std::vector<File> files;
  CacheTrim out;
  std::error_code ec;
  for (fs::directory_iterator at(folder, ec), end; !ec && at != end; at.increment(ec)) {
    std::error_code gone;
    if (at->path().extension() != extension || !at->is_regular_file(gone)) continue;
    File file{at->path(), at->last_write_time(gone), gone ? 0 : at->file_size(gone)};
    if (gone) continue;
    out.bytes += file.bytes;
    files.push_back(std::move(file));
  }
  std::ranges::sort(files, {}, &File::used);
  const std::uint64_t most = out.bytes > limits.bytes ? limits.bytes - limits.bytes / 4 : limits.bytes;
  for (const File& file : files) {
    if (out.bytes <= most && now - file.used < limits.unused) break;
    std::error_code failed;
    if (!fs::remove(file.path, failed) || failed) continue;
    ++out.removed;
    out.bytes -= file.bytes;
  }
  return out;
}

void note_cache_use(const fs::path& file) {
  std::error_code ec;
  const auto used = fs::last_write_time(file, ec), now = fs::file_time_type::clock::now();
  if (!ec && now - used > std::chrono::hours(24)) fs::last_write_time(file, now, ec);
}

}  // namespace afterglow
