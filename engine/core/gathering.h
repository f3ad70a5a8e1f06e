// SPDX-License-Identifier: MIT
// When to act on signs of change. Internal to the room. Pure: the caller tells the time.
#pragma once

#include <algorithm>
#include <chrono>
#include <optional>

namespace afterglow {

/// The first sign counts: what comes later is part of the next look. A file that is still being written is given time
/// to become whole, but not for ever.
class Gathering {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr std::chrono::milliseconds kSettle{5}, kWriting{100}, kLongest{1000};

  /// A file was closed, moved, made or removed.
  void whole(Time now) {
    begin(now);
    whole_ = true;
    due_ = std::min(due_, now + kSettle);
  }
  /// A file was written to and is still open.
  void writing(Time now) {
    begin(now);
    if (!whole_) due_ = std::min(now + kWriting, *since_ + kLongest);
  }
  /// When to act, if there is anything to act on.
  std::optional<Time> due() const { return since_ ? std::optional(due_) : std::nullopt; }
  /// The first sign, and all are forgotten. Only when something is due.
  Time take() {
    const Time first = *since_;
    since_.reset();
    whole_ = false;
    return first;
  }

 private:
  void begin(Time now) {
    if (since_) return;
    since_ = now;
    due_ = Time::max();
  }
  std::optional<Time> since_;
  bool whole_ = false;  ///< one of the signs was
  Time due_{};
};

}  // namespace afterglow
