// SPDX-License-Identifier: MIT
#include "play/transport.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_set>

#include "core/text.h"

namespace afterglow {
namespace {

// Clocks add up sums of 1/fps, which miss whole frames by rounding: a frame may come this part of itself too early.
constexpr double kEarly = 1e-6;

std::int64_t modulo(std::int64_t value, std::int64_t by) { return (value % by + by) % by; }

const std::vector<std::string>& loop_names() {
  static const std::vector<std::string> names{"once", "loop", "ping-pong"};
  return names;
}

}  // namespace

std::string loop_mode_name(LoopMode mode) { return loop_names()[static_cast<std::size_t>(mode)]; }

Result<LoopMode> parse_loop_mode(const std::string& text) {
  const auto& names = loop_names();
  const auto found = std::ranges::find(names, text);
  if (found != names.end()) return static_cast<LoopMode>(found - names.begin());
  return Error{ErrorKind::usage,         fmt::format("'{}' is no loop mode", text), "--loop", 0, join(names),
               nearest_name(text, names)};
}

Transport::Transport(int frames, double fps) {
  set_frames(frames);
  if (fps > 0 && std::isfinite(fps)) fps_ = fps;
}

void Transport::set_frames(int frames) {
  frames_ = std::max(frames, 1);
  first_ = 0;
  last_ = frames_ - 1;
  playing_ = ended_ = false;
  jump(0, false, anchor_time_);
}

void Transport::resize(int frames, double now) {
  const bool all = first_ == 0 && last_ == frames_ - 1;
  settle(now);
  frames_ = std::max(frames, 1);
  set_range(all ? 0 : std::min(first_, frames_ - 1), all ? frames_ - 1 : std::min(last_, frames_ - 1), now);
}

std::int64_t Transport::period() const {
  return loop_ == LoopMode::ping_pong ? std::max<std::int64_t>(1, 2LL * length() - 2) : length();
}

int Transport::fold(std::int64_t line) const {
  if (loop_ == LoopMode::once) return first_ + static_cast<int>(std::clamp<std::int64_t>(line, 0, length() - 1));
  const std::int64_t at = modulo(line, period());
  return first_ + static_cast<int>(at < length() ? at : period() - at);
}

std::int64_t Transport::unfold(int position, bool returning) const {
  const std::int64_t inside = position - first_;
  return returning && loop_ == LoopMode::ping_pong ? period() - inside : inside;
}

/// On the way back of a ping-pong, as it is when played forwards.
bool Transport::returning() const { return loop_ == LoopMode::ping_pong && modulo(line_, period()) > length() - 1; }

int Transport::heading() const {
  if (loop_ != LoopMode::ping_pong || length() == 1) return direction();
  const int next = fold(line_ + direction());
  return next < position_ ? -1 : 1;
}

bool Transport::at_end(std::int64_t line) const {
  if (loop_ != LoopMode::once) return false;
  return direction() > 0 ? line >= length() - 1 : line <= 0;
}

std::int64_t Transport::ticks_at(double now) const {
  const double passed = std::max(0.0, now - anchor_time_) * fps_ * std::abs(speed_);
  return static_cast<std::int64_t>(std::floor(passed + anchor_fraction_ + kEarly));
}

void Transport::settle(double now) {
  if (!playing_ || pacing_ == Pacing::every_frame) return;
  const std::int64_t ticks = ticks_at(now);
  line_ = anchor_line_ + direction() * ticks;
  tick_ = anchor_tick_ + ticks;
  if (loop_ == LoopMode::once && at_end(line_)) {
    const std::int64_t end = direction() > 0 ? length() - 1 : 0;
    tick_ -= std::abs(line_ - end);
    line_ = end;
    // The last frame is shown for as long as any other before playing ends.
    if (anchor_tick_ + ticks > tick_) {
      playing_ = false;
      ended_ = true;
    }
  }
  position_ = fold(line_);
}

/// Time counts from here. The part of the present frame that has passed is kept where only the pace changes.
void Transport::anchor(double now, bool keep_fraction) {
  double fraction = 0;
  if (keep_fraction && playing_) {
    const double passed = std::max(0.0, now - anchor_time_) * fps_ * std::abs(speed_) + anchor_fraction_;
    fraction = std::clamp(passed - std::floor(passed + kEarly), 0.0, 1.0);
  }
  anchor_time_ = now;
  anchor_fraction_ = fraction;
  anchor_line_ = line_;
  anchor_tick_ = tick_;
}

double Transport::fraction(double now) const {
  if (!playing_ || pacing_ == Pacing::every_frame) return 0;
  const double passed = std::max(0.0, now - anchor_time_) * fps_ * std::abs(speed_) + anchor_fraction_;
  return std::clamp(passed - static_cast<double>(tick_ - anchor_tick_), 0.0, 1.0);
}

double Transport::nudge(double seconds, double now) {
  if (!playing_ || pacing_ == Pacing::every_frame || !std::isfinite(seconds)) return 0;
  settle(now);
  if (!playing_) return 0;
  anchor(now, true);
  const double turn = fps_ * std::abs(speed_);
  const double by = std::max(seconds, -anchor_fraction_ / turn);
  anchor_fraction_ += by * turn;
  return by;
}

void Transport::jump(int position, bool returning, double now) {
  position_ = std::clamp(position, 0, frames_ - 1);
  line_ = unfold(position_, returning);
  // Nothing that lies between was due.
  tick_ = 0;
  shown_tick_ = -1;
  anchor(now, false);
}

void Transport::play(double now) {
  if (playing_) return;
  const bool outside = position_ < first_ || position_ > last_;
  if (outside || at_end(line_)) {
    jump(direction() > 0 ? first_ : last_, false, now);
  } else {
    line_ = unfold(position_, returning());
  }
  playing_ = true;
  ended_ = false;
  anchor(now, false);
}

void Transport::pause(double now) {
  settle(now);
  playing_ = false;
  anchor(now, false);
}

void Transport::step(int by, double now) {
  pause(now);
  ended_ = false;
  int to = position_ + by;
  const bool inside = position_ >= first_ && position_ <= last_;
  if (inside && loop_ == LoopMode::loop) to = first_ + static_cast<int>(modulo(to - first_, length()));
  if (inside && loop_ != LoopMode::loop) to = std::clamp(to, first_, last_);
  jump(to, returning(), now);
}

void Transport::go_to(int position, double now) {
  settle(now);
  ended_ = false;
  jump(position, returning(), now);
}

void Transport::set_range(int first, int last, double now) {
  settle(now);
  const bool back = returning();
  first_ = std::clamp(std::min(first, last), 0, frames_ - 1);
  last_ = std::clamp(std::max(first, last), 0, frames_ - 1);
  ended_ = false;
  jump(std::clamp(position_, first_, last_), back, now);
}

void Transport::set_speed(double speed, double now) {
  if (!std::isfinite(speed) || speed == 0) return;
  settle(now);
  const double wanted = std::copysign(std::clamp(std::abs(speed), kSlowest, kFastest), speed);
  anchor(now, (wanted < 0) == (speed_ < 0));
  if ((wanted < 0) != (speed_ < 0)) ended_ = false;
  speed_ = wanted;
}

void Transport::set_fps(double fps, double now) {
  if (!(fps > 0) || !std::isfinite(fps)) return;
  settle(now);
  anchor(now, true);
  fps_ = fps;
}

void Transport::set_loop(LoopMode mode, double now) {
  settle(now);
  const bool back = returning();
  loop_ = mode;
  ended_ = false;
  const int position = position_;
  jump(position, back, now);
}

void Transport::set_pacing(Pacing pacing, double now) {
  settle(now);
  pacing_ = pacing;
  anchor(now, false);
}

Transport::Due Transport::due(double now) {
  if (playing_ && pacing_ == Pacing::every_frame) {
    // The one that is on screen has had its turn.
    if (shown_tick_ == tick_) {
      if (at_end(line_)) {
        playing_ = false;
        ended_ = true;
      } else {
        line_ += direction();
        ++tick_;
        position_ = fold(line_);
      }
    }
  } else {
    settle(now);
  }
  return {position_, tick_, position_ != shown_position_ || shown_tick_ < 0};
}

void Transport::shown(const Due& due) {
  if (shown_tick_ >= 0 && due.tick > shown_tick_ + 1)
    dropped_ += static_cast<std::uint64_t>(due.tick - shown_tick_ - 1);
  shown_tick_ = std::max(shown_tick_, due.tick);
  shown_position_ = due.position;
}

double Transport::next_due() const {
  if (!playing_) return std::numeric_limits<double>::infinity();
  if (pacing_ == Pacing::every_frame) return anchor_time_;
  const auto ticks = static_cast<double>(tick_ - anchor_tick_ + 1);
  return anchor_time_ + (ticks - anchor_fraction_) / (fps_ * std::abs(speed_));
}

std::vector<int> Transport::upcoming(int count, int stride) const {
  std::vector<int> positions;
  std::unordered_set<int> seen{position_};
  const std::int64_t by = std::max(stride, 1);
  // With a stride, a lap touches only some of the frames; two laps are enough to know.
  const std::int64_t most = loop_ == LoopMode::once ? length() : 2 * period();
  for (std::int64_t i = 1; i * by <= most && static_cast<int>(positions.size()) < count; ++i) {
    const std::int64_t line = line_ + direction() * by * i;
    if (loop_ == LoopMode::once && (line < 0 || line >= length())) break;
    const int position = fold(line);
    if (seen.insert(position).second) positions.push_back(position);
  }
  return positions;
}

}  // namespace afterglow
