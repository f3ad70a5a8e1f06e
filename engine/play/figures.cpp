// SPDX-License-Identifier: MIT
#include "play/figures.h"

#include <algorithm>
#include <cmath>

namespace afterglow {
namespace {

constexpr std::size_t kMostWorkTimes = 100'000, kMostLatencies = 1000, kFpsFrames = 24;

template <class T>
void add(std::deque<T>& row, const T& value, std::size_t most) {
  row.push_back(value);
  if (row.size() > most) row.pop_front();
}

}  // namespace

Percentiles Percentiles::of(std::vector<double> values) {
  if (values.empty()) return {};
  auto rest = values.begin();
  // The smallest value that so many of a hundred do not exceed. Not all are sorted: this is asked for each frame. Parts
  // must ascend.
  const auto at = [&](double part) {
    const auto rank = static_cast<std::size_t>(std::ceil(part * static_cast<double>(values.size())));
    const auto place =
        values.begin() + static_cast<std::ptrdiff_t>(std::clamp<std::size_t>(rank, 1, values.size())) - 1;
    std::nth_element(rest, place, values.end());
    rest = place;
    return *place;
  };
  return {at(0.5), at(0.95), at(0.99), at(1), values.size()};
}

void Figures::frame_shown(double now, double work, bool playing) {
  ++shown_;
  if (playing) add(work_, work, kMostWorkTimes);
  if (playing && last_ >= 0) add(intervals_, (now - last_) * 1000, kMostWorkTimes);
  last_ = playing ? now : -1;
}

void Figures::reloaded(const ReloadLatency& latency) {
  ++reloads_;
  add(latencies_, latency, kMostLatencies);
  awaiting_present_ = true;
}

void Figures::presented(double milliseconds) {
  if (!awaiting_present_) return;
  awaiting_present_ = false;
  latencies_.back().present = milliseconds;
}

double Figures::fps() const {
  if (last_ < 0 || intervals_.empty()) return 0;
  const std::size_t frames = std::min(kFpsFrames, intervals_.size());
  double sum = 0;
  for (std::size_t i = intervals_.size() - frames; i < intervals_.size(); ++i) sum += intervals_[i];
  return sum > 0 ? 1000 * static_cast<double>(frames) / sum : 0;
}

void Figures::frame_unreadable(int number, const Error& why) {
  constexpr std::size_t kMost = 10000;
  ++unreadable_;
  if (unreadable_frames_.size() < kMost) unreadable_frames_.insert(number);
  if (!first_unreadable_) first_unreadable_ = why;
}

PlayerStats Figures::stats() const {
  PlayerStats stats;
  stats.interval = Percentiles::of({intervals_.begin(), intervals_.end()});
  stats.work = Percentiles::of({work_.begin(), work_.end()});
  stats.fps = fps();
  stats.rebuilding = rebuilding;
  stats.shown = shown_;
  stats.late = late;
  stats.unreadable = unreadable_;
  stats.unreadable_frames.assign(unreadable_frames_.begin(), unreadable_frames_.end());
  stats.first_unreadable = first_unreadable_;
  stats.kept = kept;
  stats.reloads = reloads_;
  stats.latencies.assign(latencies_.begin(), latencies_.end());
  return stats;
}

}  // namespace afterglow
