// SPDX-License-Identifier: MIT
#include "batch/input_watch.h"

#include <poll.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <array>

#include "core/file.h"
#include "core/file_record.h"

namespace afterglow {
namespace {

constexpr int kPause = 100;        // ms
constexpr double kSettled = 2000;  // ms
constexpr std::uint32_t kWhole = IN_CLOSE_WRITE | IN_MOVED_TO, kWriting = IN_MODIFY | IN_CREATE;

Hash stamp_now(const std::filesystem::path& file) { return inspect(file, FileProbe::Kind::stamp).seen; }

}  // namespace

InputWatch::InputWatch(const FrameRecords& frames) : events_(inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {
  std::set<std::filesystem::path> seen;
  for (const auto& frame : frames)
    for (const auto& file : frame.job.sources()) {
      const auto folder = file.parent_path();
      if (!seen.insert(folder).second || events_.get() < 0) continue;
      const std::string name = folder.empty() ? "." : folder.string();
      const int watch = inotify_add_watch(events_.get(), name.c_str(), kWhole | kWriting);
      if (watch >= 0) folders_[watch].insert(folder);
    }
}

void InputWatch::wait() {
  pollfd ready{events_.get(), POLLIN, 0};
  if (poll(&ready, 1, kPause) > 0) take_events();
}

void InputWatch::take_events() {
  alignas(inotify_event) std::array<char, 16384> buffer{};
  for (ssize_t size = 0; (size = read(events_.get(), buffer.data(), buffer.size())) > 0;)
    for (ssize_t at = 0; at < size;) {
      const auto* event = reinterpret_cast<const inotify_event*>(buffer.data() + at);
      at += static_cast<ssize_t>(sizeof(inotify_event) + event->len);
      const auto folder = folders_.find(event->wd);
      if (folder == folders_.end() || event->len == 0) continue;
      for (const auto& name : folder->second) {
        const auto path = name / event->name;
        File& file = files_[path];
        file.open = (event->mask & kWhole) == 0;
        if (!file.open) file.closed = stamp_now(path);
      }
    }
}

bool InputWatch::is_whole(const std::filesystem::path& path, File& file) {
  const Hash stamp = stamp_now(path);
  if (stamp != file.stamp) {
    file.stamp = stamp;
    file.since = Clock::now();
  }
  return stamp == file.closed || (!file.open && milliseconds_since(file.since) > kSettled);
}

std::optional<Hash> InputWatch::whole(const FrameJob& job) {
  Hasher hasher;
  for (const auto& path : job.sources()) {
    if (!is_file(path) || !is_whole(path, files_[path])) return std::nullopt;
    hasher.add(files_[path].stamp.hex());
  }
  return hasher.finish();
}

}  // namespace afterglow
