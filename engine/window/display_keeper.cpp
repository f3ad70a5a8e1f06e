// SPDX-License-Identifier: MIT
#include "window/display_keeper.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "core/exception.h"
#include "core/watch.h"

namespace afterglow {

struct DisplayKeeper::State {
  /// By which a file is known to be as it was.
  struct Trace {
    std::filesystem::file_time_type time;
    std::uintmax_t size = 0;
    friend bool operator==(const Trace&, const Trace&) = default;
  };
  static std::vector<Trace> traces_of(const std::vector<std::filesystem::path>& files) {
    std::vector<Trace> out;
    for (const auto& file : files) {
      std::error_code none;
      Trace trace;
      trace.time = std::filesystem::last_write_time(file, none);
      trace.size = none ? 0 : std::filesystem::file_size(file, none);
      out.push_back(trace);
    }
    return out;
  }

  MakeDisplay make;
  std::function<void()> wake;
  std::mutex mutex;
  std::condition_variable asked;
  bool ends = false, look = false, chosen = false;
  std::string display, view;              ///< that are wanted
  std::string shown_display, shown_view;  ///< that were made last
  std::optional<Result<ShownDisplay>> made;
  std::vector<std::filesystem::path> files;
  std::vector<Trace> traces;  ///< of `files`, before they were read
  std::unique_ptr<Watcher> watcher;
  std::thread worker;

  void run();
  void make_one(std::unique_lock<std::mutex>& lock);
};

void DisplayKeeper::State::run() {
  std::unique_lock lock(mutex);
  while (true) {
    asked.wait(lock, [&] { return ends || look || chosen; });
    if (ends) return;
    look = false;
    if (std::exchange(chosen, false) || traces_of(files) != traces) make_one(lock);
  }
}

/// Unlocks while it works.
void DisplayKeeper::State::make_one(std::unique_lock<std::mutex>& lock) {
  const std::string name = display, of_it = view;
  std::vector<std::filesystem::path> read = files;
  std::vector<Trace> before = traces_of(read);
  lock.unlock();
  Result<ShownDisplay> result = without_exceptions([&] { return make(name, of_it); });
  if (result && result->files != read) {  // it is made of others: any change from here on counts
    read = result->files;
    watcher->watch(read);
    before = traces_of(read);
  }
  lock.lock();
  files = std::move(read);
  traces = std::move(before);
  if (result) {
    shown_display = result->display;
    shown_view = result->view;
  }
  if (!chosen) {  // where it failed, what is on screen is what files are read for again
    display = shown_display;
    view = shown_view;
  }
  made = std::move(result);
  lock.unlock();
  wake();
  lock.lock();
}

DisplayKeeper::DisplayKeeper(const ShownDisplay& shown, MakeDisplay make, std::function<void()> wake)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.make = std::move(make);
  s.wake = std::move(wake);
  s.display = s.shown_display = shown.display;
  s.view = s.shown_view = shown.view;
  s.files = shown.files;
  s.traces = State::traces_of(s.files);
  s.watcher = std::make_unique<Watcher>(WatchOptions{}, [&s](auto, bool) {
    {
      const std::lock_guard lock(s.mutex);
      s.look = true;
    }
    s.asked.notify_one();
  });
  s.watcher->watch(s.files);
  s.worker = std::thread([&s] { s.run(); });
}

DisplayKeeper::~DisplayKeeper() {
  {
    const std::lock_guard lock(state_->mutex);
    state_->ends = true;
  }
  state_->asked.notify_one();
  state_->worker.join();
  state_->watcher.reset();
}

void DisplayKeeper::choose(const std::string& display, const std::string& view) {
  {
    const std::lock_guard lock(state_->mutex);
    state_->display = display;
    state_->view = view;
    state_->chosen = true;
  }
  state_->asked.notify_one();
}

std::optional<Result<ShownDisplay>> DisplayKeeper::take() {
  const std::lock_guard lock(state_->mutex);
  return std::exchange(state_->made, std::nullopt);
}

}  // namespace afterglow
