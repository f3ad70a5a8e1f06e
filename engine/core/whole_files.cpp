// SPDX-License-Identifier: MIT
#include "core/whole_files.h"

#include <poll.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <system_error>

#include "core/file.h"
#include "core/file_record.h"

namespace afterglow {
namespace {

constexpr int kPause = 100;        // ms
constexpr double kSettled = 2000;  // ms
constexpr std::uint32_t kWhole = IN_CLOSE_WRITE | IN_MOVED_TO, kWriting = IN_MODIFY | IN_CREATE;

/// A file that came with this name alone is one that somebody has begun to write. Links come to what is there already.
bool is_begun(const std::filesystem::path& file) {
  struct stat status {};
  return lstat(file.c_str(), &status) == 0 && S_ISREG(status.st_mode) && status.st_nlink == 1;
}

Hash stamp_now(const std::filesystem::path& file) { return inspect(file, FileProbe::Kind::stamp).seen; }

}  // namespace

WholeFiles::WholeFiles(const std::set<std::filesystem::path>& folders)
    : events_(inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {
  if (events_.get() < 0) return;
  for (const auto& folder : folders) {
    const std::string name = folder.empty() ? "." : folder.string();
    const int watch = inotify_add_watch(events_.get(), name.c_str(), kWhole | kWriting);
    if (watch >= 0) folders_[watch].insert(folder);
  }
}

bool WholeFiles::wait() {
  pollfd ready{events_.get(), POLLIN, 0};
  if (poll(&ready, 1, kPause) <= 0) return false;
  take_events();
  return true;
}

void WholeFiles::take_events() {
  alignas(inotify_event) std::array<char, 16384> buffer{};
  for (ssize_t size = 0; (size = read(events_.get(), buffer.data(), buffer.size())) > 0;)
    for (ssize_t at = 0; at < size;) {
      const auto* event = reinterpret_cast<const inotify_event*>(buffer.data() + at);
      at += static_cast<ssize_t>(sizeof(inotify_event) + event->len);
      if (event->mask & IN_Q_OVERFLOW)  // some were lost, and with them what was closed
        for (auto& [path, file] : files_) file.open = false;
      const auto folder = folders_.find(event->wd);
      if (folder == folders_.end() || event->len == 0) continue;
      for (const auto& name : folder->second) {
        const auto path = name / event->name;
        File& file = files_[path];
        const bool closed = (event->mask & kWhole) != 0;
        file.open = !closed && ((event->mask & IN_MODIFY) != 0 || is_begun(path));
        if (closed) file.closed = stamp_now(path);
        if ((event->mask & IN_MOVED_TO) != 0) file.moved = file.closed;
      }
    }
}

bool WholeFiles::is_whole(const std::filesystem::path& path, File& file) {
  const Hash stamp = stamp_now(path);
  if (stamp != file.stamp) {
    file.stamp = stamp;
    file.since = Clock::now();
  }
  return stamp == file.closed || (!file.open && milliseconds_since(file.since) > kSettled);
}

std::optional<Hash> WholeFiles::whole(const std::filesystem::path& path) {
  File& file = files_[path];
  if (!is_file(path) || !is_whole(path, file)) return std::nullopt;
  return file.stamp;
}

bool WholeFiles::may_grow(const std::filesystem::path& path) {
  constexpr std::chrono::seconds kPause{10};
  std::error_code ec;
  const auto written = std::filesystem::last_write_time(path, ec);
  const auto age = std::filesystem::file_time_type::clock::now() - written;
  const File& file = files_[path];
  return !ec && age < kPause && age > -kPause && (file.moved == Hash() || file.moved != stamp_now(path));
}

}  // namespace afterglow
