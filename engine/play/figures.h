// SPDX-License-Identifier: MIT
// What playing has to say for itself: pace, drops, and how long an edit takes to be seen.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/result.h"
#include "play/read_ahead.h"
#include "session/live.h"

namespace afterglow {

/// Of a row of milliseconds; all 0 without any.
struct Percentiles {
  double median = 0, p95 = 0, p99 = 0, most = 0;
  std::size_t count = 0;
  static Percentiles of(std::vector<double> values);
};

/// From a change on disk (or in the panel) to the new picture, in milliseconds.
struct ReloadLatency {
  BuildTimes build;    ///< notice, script, shader, pipeline, and the wait for the end of a frame
  double execute = 0;  ///< the first frame of the new stack, upload included
  double present = 0;  ///< from there until it was handed to the screen; 0 without a window
  double total() const {
    return build.notice + build.script + build.shader + build.pipeline + build.warm_up + build.wait + execute + present;
  }
};

struct PlayerStats {
  Percentiles interval;                ///< between frames while playing
  Percentiles work;                    ///< for a frame while playing, on the drawing thread: upload and passes
  double fps = 0;                      ///< of the last frames; 0 while paused
  std::uint64_t shown = 0;             ///< frames put on screen
  std::uint64_t dropped = 0;           ///< due and never shown
  std::uint64_t late = 0;              ///< times that the due picture had not been read yet
  std::uint64_t unreadable = 0;        ///< frames that could not be read
  std::vector<int> unreadable_frames;  ///< their numbers, each once; at most 10,000
  std::optional<Error> first_unreadable;
  std::uint64_t kept = 0;        ///< frames shown that needed no pass: the same content and settings
  std::uint64_t rebuilding = 0;  ///< frames due while their structure was being built: the one before stayed
  std::uint64_t reloads = 0;     ///< builds taken
  ReadAhead::Stats cache;
  std::vector<ReloadLatency> latencies;  ///< of the last builds taken, at most 1000
};

/// Collects them. Times in seconds of the player's clock. Not thread-safe.
class Figures {
 public:
  /// `work`: milliseconds that the drawing thread was busy.
  void frame_shown(double now, double work, bool playing);
  /// Playing was interrupted: the time until the next frame is no interval.
  void stop() { last_ = -1; }
  void reloaded(const ReloadLatency& latency);
  /// Adds the time to the screen to the last reload, once.
  void presented(double milliseconds);
  PlayerStats stats() const;
  double fps() const;  ///< PlayerStats::fps
  void frame_unreadable(int number, const Error& why);
  std::uint64_t frames_had() const { return shown_ + unreadable_; }

  std::uint64_t late = 0, kept = 0, rebuilding = 0;

 private:
  std::deque<double> intervals_, work_;
  std::deque<ReloadLatency> latencies_;
  bool awaiting_present_ = false;
  double last_ = -1;
  std::uint64_t shown_ = 0, unreadable_ = 0, reloads_ = 0;
  std::set<int> unreadable_frames_;
  std::optional<Error> first_unreadable_;
};

}  // namespace afterglow
