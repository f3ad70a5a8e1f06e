// SPDX-License-Identifier: MIT
// What a thread needs for its part of the work, buffers above all, handed from part to part: memory that was touched
// once is cheap, new memory costs a page fault for every 4 KiB.
#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace afterglow {

/// Holds as many things as were in use at a time. Thread-safe. Must outlive what is borrowed.
template <class Thing>
class Spares {
 public:
  class Borrowed {
   public:
    Borrowed(Spares& home, std::unique_ptr<Thing> thing) : home_(&home), thing_(std::move(thing)) {}
    Borrowed(const Borrowed&) = delete;
    Borrowed& operator=(const Borrowed&) = delete;
    ~Borrowed() { home_->give(std::move(thing_)); }
    Thing& operator*() const { return *thing_; }
    Thing* operator->() const { return thing_.get(); }

   private:
    Spares* home_;
    std::unique_ptr<Thing> thing_;
  };

  /// One that nobody uses, as it was left; where there is none, `make()` makes one: a std::unique_ptr<Thing>.
  template <class Make>
  Borrowed borrow(const Make& make) {
    {
      const std::lock_guard lock(mutex_);
      if (!free_.empty()) {
        std::unique_ptr<Thing> thing = std::move(free_.back());
        free_.pop_back();
        return {*this, std::move(thing)};
      }
      free_.reserve(++made_);  // so that giving back asks for no memory
    }
    return {*this, make()};
  }

 private:
  void give(std::unique_ptr<Thing> thing) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(thing));
  }

  std::mutex mutex_;
  std::vector<std::unique_ptr<Thing>> free_;
  std::size_t made_ = 0;
};

}  // namespace afterglow
