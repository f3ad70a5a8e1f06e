// SPDX-License-Identifier: MIT
#include "core/parallel.h"

#include <fmt/format.h>
#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "core/locale.h"

namespace afterglow {
namespace {

/// Asked once: rooms are made for as many threads as there may be.
std::size_t processors() {
  static const std::size_t known = std::max(1u, std::thread::hardware_concurrency());
  return known;
}

/// A thread that hears no signals: those are the host's matter, and its threads'.
template <class Work>
std::thread quiet_thread(Work work) {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  const struct Restore {
    const sigset_t& before;
    ~Restore() { pthread_sigmask(SIG_SETMASK, &before, nullptr); }
  } restore{before};
  return std::thread(std::move(work));
}

/// A loop on its caller's thread, which others help with.
struct Loop {
  const std::function<void(std::size_t)>& work;
  std::size_t count;
  std::size_t wanted;       ///< threads that may still join
  std::size_t helping = 0;  ///< that have joined and not left
  std::atomic<std::size_t> next = 0;
  std::exception_ptr failure{};  ///< the first
};

/// What each of a loop's threads does; `mutex` is for its failure.
void work_on(Loop& loop, std::mutex& mutex) {
  const PlainLocale plain;
  try {
    for (std::size_t i = loop.next++; i < loop.count; i = loop.next++) loop.work(i);
  } catch (...) {
    loop.next = loop.count;
    const std::lock_guard lock(mutex);
    if (!loop.failure) loop.failure = std::current_exception();
  }
}

/// Threads that wait for loops to help with; as many as the machine has processors beside the caller's, made when they
/// are first wanted. A caller never waits for one to come.
class Helpers {
 public:
  void run(Loop& loop) {
    const bool helped = call(loop);
    work_on(loop, mutex_);
    if (helped) {
      std::unique_lock lock(mutex_);
      std::erase(loops_, &loop);
      left_.wait(lock, [&] { return loop.helping == 0; });
    }
    if (loop.failure) std::rethrow_exception(loop.failure);
  }

  /// Waits for them; loops of threads that go on have no help then.
  void end() {
    std::vector<std::thread> threads;
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
      threads.swap(threads_);
    }
    called_.notify_all();
    for (auto& thread : threads) thread.join();
  }

 private:
  /// False: it has to do without.
  bool call(Loop& loop) {
    const std::lock_guard lock(mutex_);
    if (ended_) return false;
    try {
      loops_.push_back(&loop);
    } catch (const std::bad_alloc&) {
      return false;
    }
    try {
      const std::size_t most = processors() - 1;
      while (threads_.size() < std::min(most, busy_ + loop.wanted)) {
        threads_.reserve(most);
        threads_.push_back(quiet_thread([this] { help(); }));
      }
    } catch (const std::exception&) {
      // No more threads to be had: those that are there do the work.
    }
    if (loop.wanted == 1)
      called_.notify_one();
    else
      called_.notify_all();
    return true;
  }

  void help() {
    std::unique_lock lock(mutex_);
    while (true) {
      called_.wait(lock, [&] { return ended_ || !loops_.empty(); });
      if (ended_) return;
      Loop& loop = *loops_.front();
      if (--loop.wanted == 0) loops_.pop_front();
      ++loop.helping;
      ++busy_;
      lock.unlock();
      work_on(loop, mutex_);
      lock.lock();
      std::erase(loops_, &loop);  // there is nothing left to begin
      --busy_;
      if (--loop.helping == 0) left_.notify_all();
    }
  }

  std::mutex mutex_;
  std::condition_variable called_, left_;
  std::deque<Loop*> loops_;  ///< that want help
  std::vector<std::thread> threads_;
  std::size_t busy_ = 0;
  bool ended_ = false;
};

/// Never freed: threads that nobody waits for may outlive what is static.
constinit std::atomic<Helpers*> all_helpers = nullptr;

/// A child of fork() has none of the threads, and makes its own. What is asked once is asked here: where a fork came
/// while another thread asked, its child would wait for the answer for ever.
const struct Registered {
  Registered() {
    static_cast<void>(processors());
    const PlainLocale asked;
    pthread_atfork(nullptr, nullptr, [] { all_helpers = nullptr; });
  }
  ~Registered() {
    if (Helpers* const made = all_helpers) made->end();
  }
} registered;

Helpers& helpers() {
  Helpers* known = all_helpers;
  if (known) return *known;
  auto own = std::make_unique<Helpers>();
  if (all_helpers.compare_exchange_strong(known, own.get())) return *own.release();
  return *known;
}

thread_local bool is_alone = false;

// For threads that have ended: a tenth of a second at most, as a rule less than a millisecond.
constexpr std::chrono::microseconds kWait(50);
constexpr int kMostWaits = 2000;

}  // namespace

void loop_alone() { is_alone = true; }

bool can_start_threads(std::size_t count) {
  std::atomic<bool> all = false;
  std::vector<pid_t> ids(count);
  std::vector<std::thread> threads;
  threads.reserve(count);
  try {
    for (pid_t& id : ids)
      threads.push_back(quiet_thread([&] {
        id = gettid();
        all.wait(false);
      }));
  } catch (const std::exception&) {
    // Those that began are the answer.
  }
  all = true;
  all.notify_all();
  for (std::thread& thread : threads) thread.join();
  // The system counts a thread for a moment after it has been joined.
  int waits = 0;
  for (std::size_t i = 0; i < threads.size(); ++i) {
    const std::string task = fmt::format("/proc/self/task/{}", ids[i]);
    for (; waits < kMostWaits && access(task.c_str(), F_OK) == 0; ++waits) std::this_thread::sleep_for(kWait);
  }
  return threads.size() == count;
}

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& work) {
  if (count > 1 && !is_alone && processors() > 1) {
    Loop loop{work, count, std::min(count, processors()) - 1};
    return helpers().run(loop);
  }
  for (std::size_t i = 0; i < count; ++i) work(i);
}

void parallel_tasks(std::size_t count, const std::function<void(std::size_t)>& work) {
  Loop loop{work, count, 0};
  std::mutex mutex;
  const auto run = [&] { work_on(loop, mutex); };
  {
    std::vector<std::jthread> others;
    const std::size_t threads = std::min(count, processors());
    others.reserve(threads);
    for (std::size_t i = 1; i < threads; ++i) {
      try {
        others.emplace_back(run);
      } catch (const std::system_error&) {
        break;  // no more threads to be had: those that run do the work
      }
    }
    run();
  }
  if (loop.failure) std::rethrow_exception(loop.failure);
}

}  // namespace afterglow
