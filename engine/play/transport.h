// SPDX-License-Identifier: MIT
// Which frame is due when: play, pause, step, scrub, loop, range, speed. Arithmetic alone: the time comes from whoever
// calls, in seconds of any clock that never goes backwards.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/result.h"

namespace afterglow {

/// What happens where the range ends. `ping_pong` shows the frames at both turns once.
enum class LoopMode { once, loop, ping_pong };
/// "once", "loop", "ping-pong".
std::string loop_mode_name(LoopMode mode);
/// Errors: usage.
Result<LoopMode> parse_loop_mode(const std::string& text);

/// `real_time`: frames are due by the clock, late ones are dropped. `every_frame`: each turn is the next frame's,
/// whatever the clock says.
enum class Pacing { real_time, every_frame };

/// Positions count from 0: the first frame of the footage. Not thread-safe.
class Transport {
 public:
  static constexpr double kSlowest = 0.1, kFastest = 8;

  /// Paused at the first frame. `frames` ≥ 1; `fps` > 0.
  explicit Transport(int frames, double fps = 24);

  int frames() const { return frames_; }
  bool playing() const { return playing_; }
  /// Once: the end of the range was reached by playing, and nothing has moved since.
  bool ended() const { return ended_; }
  double fps() const { return fps_; }
  double speed() const { return speed_; }  ///< negative: backwards
  LoopMode loop() const { return loop_; }
  Pacing pacing() const { return pacing_; }
  int first() const { return first_; }  ///< of the range
  int last() const { return last_; }
  int position() const { return position_; }  ///< as of the last call
  /// How much of the present frame's time has passed, 0…1; 0 where no clock counts.
  double fraction(double now) const;
  /// +1 or −1: where the next frame lies. With ping-pong it turns at the ends.
  int heading() const;

  /// From the end of the range, when there is nothing left to play, it begins anew.
  void play(double now);
  void pause(double now);
  void toggle(double now) { playing_ ? pause(now) : play(now); }
  /// Pauses and moves by that many frames; over the ends of the range as the loop mode says (ping-pong stops there).
  void step(int by, double now);
  /// Scrub: goes there, within the footage; the range follows no one. Goes on playing if it was.
  void go_to(int position, double now);
  void go_to_first(double now) { go_to(first_, now); }
  void go_to_last(double now) { go_to(last_, now); }
  /// Both within the footage, in either order. The position is brought into it when it lies outside.
  void set_range(int first, int last, double now);
  void clear_range(double now) { set_range(0, frames_ - 1, now); }
  /// 0.1…8 forwards, −0.1…−8 backwards; held there when beyond. What is no number is ignored.
  void set_speed(double speed, double now);
  void set_fps(double fps, double now);
  void set_loop(LoopMode mode, double now);
  void set_pacing(Pacing pacing, double now);
  /// Other footage: paused at its start, without a range.
  void set_frames(int frames);

  /// While it plays by the clock: frames are due that many seconds earlier, or later (below 0; the present frame stays,
  /// it is the next one that waits). No jump, nothing is dropped for it. Returns what was done of it.
  double nudge(double seconds, double now);

  /// The same footage, longer or shorter: all stays as it is, as far as it can. A range of all of it stays one.
  void resize(int frames, double now);

  /// What ought to be on screen.
  struct Due {
    int position = 0;
    /// Counts frames that were due since playing began or the position was moved; grows by more than 1 when some were
    /// missed.
    std::int64_t tick = 0;
    bool moved = false;  ///< it is another one than that shown last (`shown`)
  };
  /// The frame that is due now. With Pacing::every_frame it is the one after the last that was `shown`.
  Due due(double now);
  /// Tells that this one is on screen: what was due between it and the one shown before counts as dropped.
  void shown(const Due& due);
  std::uint64_t dropped() const { return dropped_; }
  /// When the next frame is due; infinity when nothing will move.
  double next_due() const;

  /// The positions that will be due after the present one, in order, without repetition, at most `count`; every
  /// `stride`-th when frames are dropped anyway. Paused, those that playing would show.
  std::vector<int> upcoming(int count, int stride = 1) const;

 private:
  int length() const { return last_ - first_ + 1; }
  std::int64_t period() const;
  /// Positions lie on an endless line; the loop mode says how it is folded into the range.
  int fold(std::int64_t line) const;
  std::int64_t unfold(int position, bool returning) const;
  bool returning() const;
  bool at_end(std::int64_t line) const;
  std::int64_t ticks_at(double now) const;
  int direction() const { return speed_ < 0 ? -1 : 1; }
  void settle(double now);  ///< brings `position_` up to date
  void anchor(double now, bool keep_fraction);
  void jump(int position, bool returning, double now);

  int frames_ = 1, first_ = 0, last_ = 0, position_ = 0;
  double fps_ = 24, speed_ = 1;
  LoopMode loop_ = LoopMode::loop;
  Pacing pacing_ = Pacing::real_time;
  bool playing_ = false, ended_ = false;
  std::int64_t line_ = 0;         ///< of `position_`
  std::int64_t anchor_line_ = 0;  ///< where it was at `anchor_time_`
  double anchor_time_ = 0, anchor_fraction_ = 0;
  std::int64_t tick_ = 0, anchor_tick_ = 0;
  std::int64_t shown_tick_ = -1;
  int shown_position_ = -1;
  std::uint64_t dropped_ = 0;
};

}  // namespace afterglow
