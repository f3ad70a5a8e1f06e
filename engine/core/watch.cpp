// SPDX-License-Identifier: MIT
#include "core/watch.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <condition_variable>
#include <cstring>
#include <exception>
#include <map>
#include <mutex>
#include <set>
#include <thread>

#include "core/file_descriptor.h"
#include "core/gathering.h"
#include "core/stopwatch.h"
#include "core/watch_places.h"

namespace afterglow {
namespace fs = std::filesystem;
namespace {

constexpr std::uint32_t kCome = IN_CREATE | IN_MOVED_TO | IN_MOVED_FROM | IN_DELETE | IN_DELETE_SELF | IN_MOVE_SELF;
constexpr std::uint32_t kWritten = IN_CLOSE_WRITE | IN_MODIFY | IN_ATTRIB;
constexpr std::uint32_t kLost = IN_Q_OVERFLOW | IN_UNMOUNT | IN_DELETE_SELF | IN_MOVE_SELF;  // of whole folders

/// What to watch in each folder: the kinds of event, and of which names.
using Folders = std::map<std::string, std::pair<std::uint32_t, std::set<std::string>>>;

Folders folders_of(const std::vector<fs::path>& paths) {
  Folders folders;
  for (const auto& path : paths)
    for (const auto& place : watch_places(path)) {
      auto& [mask, wanted] = folders[place.folder];
      mask |= kCome | (place.content ? kWritten : 0);
      wanted.insert(place.name);
    }
  return folders;
}

}  // namespace

struct Watcher::State {
  State(const WatchOptions& options_in, Look look_in)
      : options(options_in),
        look(std::move(look_in)),
        events(options.poll ? -1 : inotify_init1(IN_NONBLOCK | IN_CLOEXEC)),
        wake(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
    if (options.poll)
      why_polling = "asked for";
    else if (events.get() < 0)
      why_polling = fmt::format("no inotify: {}", std::strerror(errno));
    else if (wake.get() < 0)  // then it wakes by itself
      why_polling = fmt::format("no eventfd: {}", std::strerror(errno));
    always_polling = why_polling;
  }

  const WatchOptions options;
  const Look look;
  FileDescriptor events, wake;
  std::string always_polling;  ///< why, whatever is watched

  mutable std::mutex mutex;  // for all below
  std::vector<fs::path> paths;
  std::map<int, std::set<std::string>> names;  ///< by watch: what matters in its folder; "*": everything
  std::string why_polling;
  Gathering gathering;
  Clock::time_point next_poll = Clock::now();
  bool ends = false;
  std::thread thread;

  void refresh();
  void watch(const Folders& folders);
  void read_events();
  void handle(const inotify_event& event, const char* name);
  int timeout() const;
  void turn(std::unique_lock<std::mutex>& lock);
  void run();
  void poke() const {
    const std::uint64_t one = 1;
    static_cast<void>(write(wake.get(), &one, sizeof one));
  }
};

/// Watches what the paths lead through now. A folder that took the place of another gets a watch of its own.
void Watcher::State::refresh() {
  constexpr int kMostTries = 5;
  Folders folders = folders_of(paths);
  for (int i = 0; i < kMostTries; ++i) {
    watch(folders);
    // What came into being before its folder was watched shows up now.
    Folders again = folders_of(paths);
    if (again == folders) return;
    folders = std::move(again);
  }
}

void Watcher::State::watch(const Folders& folders) {
  why_polling = always_polling;
  std::map<int, std::set<std::string>> now;
  for (const auto& [folder, what] : folders) {
    if (why_polling.empty()) why_polling = why_unnoticed(folder);
    if (events.get() < 0) continue;
    const int watch = inotify_add_watch(events.get(), folder.c_str(), what.first | IN_ONLYDIR);
    if (watch >= 0)
      now[watch].insert(what.second.begin(), what.second.end());
    else if (errno != ENOENT && errno != ENOTDIR && why_polling.empty())  // gone again: its own folder tells of it
      why_polling = fmt::format("{} cannot be watched: {}", folder, std::strerror(errno));
  }
  for (const auto& [watch, wanted] : names)
    if (!now.contains(watch)) inotify_rm_watch(events.get(), watch);
  names = std::move(now);
}

void Watcher::State::handle(const inotify_event& event, const char* name) {
  if (event.mask & IN_Q_OVERFLOW) return gathering.whole(Clock::now());
  const auto watch = names.find(event.wd);
  if (watch == names.end()) return;  // of a watch that was removed
  if (!(event.mask & kLost) && !watch->second.contains("*") && !watch->second.contains(name)) return;
  constexpr std::uint32_t kUnfinished = IN_MODIFY | IN_ATTRIB;
  if ((event.mask & kUnfinished) && !(event.mask & ~(kUnfinished | IN_ISDIR)))
    gathering.writing(Clock::now());
  else
    gathering.whole(Clock::now());
}

void Watcher::State::read_events() {
  alignas(inotify_event) std::array<char, 16384> buffer;
  for (ssize_t size; events.get() >= 0 && (size = read(events.get(), buffer.data(), buffer.size())) > 0;) {
    for (const char* at = buffer.data(); at < buffer.data() + size;) {
      const auto& event = *reinterpret_cast<const inotify_event*>(at);
      handle(event, event.len ? event.name : "");
      at += sizeof(inotify_event) + event.len;
    }
  }
}

/// Milliseconds until there is something to do, rounded up; -1: for ever.
int Watcher::State::timeout() const {
  std::optional<Clock::time_point> next = gathering.due();
  if (!why_polling.empty()) next = std::min(next.value_or(next_poll), next_poll);
  if (!next) return -1;
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(*next - Clock::now());
  return static_cast<int>(std::max<std::int64_t>(left.count(), 0));
}

/// Waits for something to happen, and acts on it.
void Watcher::State::turn(std::unique_lock<std::mutex>& lock) {
  std::array<pollfd, 2> wait{{{wake.get(), POLLIN, 0}, {events.get(), POLLIN, 0}}};
  const int milliseconds = timeout();
  lock.unlock();
  poll(wait.data(), wait.size(), milliseconds);
  lock.lock();
  if (ends) return;
  std::uint64_t count = 0;
  static_cast<void>(read(wake.get(), &count, sizeof count));
  read_events();
  const auto now = Clock::now();
  const bool signs = gathering.due() && now >= *gathering.due();
  const bool polls = !why_polling.empty() && now >= next_poll;
  if (!signs && !polls) return;
  const bool polled = !gathering.due();
  const auto since = polled ? now : gathering.take();
  refresh();
  lock.unlock();
  look(since, polled);
  lock.lock();
  next_poll = Clock::now() + options.interval;
}

void Watcher::State::run() {
  std::unique_lock lock(mutex);
  while (!ends) {
    try {
      turn(lock);
    } catch (const std::exception&) {  // out of memory: whatever happened, look again
      if (!lock.owns_lock()) lock.lock();
      gathering.whole(Clock::now());
    }
  }
}

Watcher::Watcher(const WatchOptions& options, Look look) : state_(std::make_unique<State>(options, std::move(look))) {
  state_->thread = std::thread([this] { state_->run(); });
}

Watcher::~Watcher() {
  {
    const std::lock_guard lock(state_->mutex);
    state_->ends = true;
  }
  state_->poke();
  state_->thread.join();
}

void Watcher::watch(const std::vector<fs::path>& paths) {
  {
    const std::lock_guard lock(state_->mutex);
    state_->paths = paths;
    state_->refresh();
  }
  state_->poke();
}

std::string Watcher::method() const {
  const std::lock_guard lock(state_->mutex);
  if (state_->why_polling.empty()) return "inotify";
  return fmt::format("polling every {} ms: {}", state_->options.interval.count(), state_->why_polling);
}

}  // namespace afterglow
