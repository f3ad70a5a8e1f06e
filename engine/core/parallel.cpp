// SPDX-License-Identifier: MIT
#include "core/parallel.h"

#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace afterglow {
namespace {

/// A loop on its caller's thread, which others help with.
struct Loop {
  const std::function<void(std::size_t)>& work;
  std::size_t count;
  std::size_t wanted;       ///< threads that may still join
  std::size_t helping = 0;  ///< that have joined and not left
  std::atomic<std::size_t> next = 0;
  std::exception_ptr failure{};  ///< the first
};

/// Threads that wait for loops to help with; as many as the machine has processors beside the caller's, made when they
/// are first wanted. A caller never waits for one to come.
class Helpers {
 public:
  void run(Loop& loop) {
    const bool helped = call(loop);
    work_on(loop);
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
      const std::size_t most = std::max(1u, std::thread::hardware_concurrency()) - 1;
      while (threads_.size() < std::min(most, busy_ + loop.wanted)) threads_.emplace_back([this] { help(); });
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
      work_on(loop);
      lock.lock();
      --busy_;
      if (--loop.helping == 0) left_.notify_all();
    }
  }

  void work_on(Loop& loop) {
    try {
      for (std::size_t i = loop.next++; i < loop.count; i = loop.next++) loop.work(i);
    } catch (...) {
      loop.next = loop.count;
      const std::lock_guard lock(mutex_);
      if (!loop.failure) loop.failure = std::current_exception();
    }
  }

  std::mutex mutex_;
  std::condition_variable called_, left_;
  std::deque<Loop*> loops_;  ///< that want help
  std::vector<std::thread> threads_;
  std::size_t busy_ = 0;
  bool ended_ = false;
};

/// Never freed: threads that nobody waits for may outlive what is static. A child of fork() has none of the threads,
/// and makes its own.
std::atomic<Helpers*> all_helpers = nullptr;

Helpers& helpers() {
  static const bool made = [] {
    all_helpers = new Helpers;
    pthread_atfork(nullptr, nullptr, [] { all_helpers = new Helpers; });
    return true;
  }();
  static_cast<void>(made);
  static const struct Ending {
    ~Ending() { all_helpers.load()->end(); }  // before the program, or the library, goes
  } ending;
  return *all_helpers;
}

}  // namespace

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& work) {
  if (count == 0) return;
  if (count == 1) return work(0);
  Loop loop{work, count, count - 1};
  helpers().run(loop);
}

}  // namespace afterglow
