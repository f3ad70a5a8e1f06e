// SPDX-License-Identifier: MIT
#include "window/timeline_ruler.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace afterglow {
namespace {

/// 1, 2, 5, 10, 20, 50, …: the first that is not below `least`.
long long round_step(double least) {
  for (long long ten = 1;; ten *= 10)
    for (const long long step : {ten, 2 * ten, 5 * ten})
      if (static_cast<double>(step) >= least) return step;
}

long long small_step(long long step) {
  if (step == 1) return 1;
  for (long long ten = 1;; ten *= 10) {
    if (step == 2 * ten) return ten;
    if (step == 5 * ten || step == 10 * ten) return step == 5 * ten ? ten : 2 * ten;
  }
}

struct Ruler {
  const Footage& footage;
  const RulerSpace& space;
  std::vector<RulerTick> out{};
  float label_end = -std::numeric_limits<float>::infinity();

  float left(int position) const {
    return space.width * static_cast<float>(position) / static_cast<float>(footage.frames());
  }
  float middle(int position) const { return (left(position) + left(position + 1)) / 2; }
  int number(int position) const { return footage.frame(position).number; }

  void add_label(int position) {
    RulerTick tick{.x = middle(position), .label = std::to_string(number(position))};
    const float width = space.width_of(tick.label);
    tick.label_x = std::clamp(tick.x - width / 2, 0.0f, std::max(space.width - width, 0.0f));
    if (tick.label_x < label_end + space.gap || width > space.width) {
      tick.label.clear();
    } else {
      label_end = tick.label_x + width;
    }
    out.push_back(std::move(tick));
  }

  void add_clip(const Footage::Clip& clip) {
    const int end = clip.first + clip.frames;
    const int first = number(clip.first), last = number(end - 1);
    const int span = std::abs(last - first) + 1;
    const float widest = std::max(space.width_of(std::to_string(first)), space.width_of(std::to_string(last)));
    const double per_number = static_cast<double>(left(end) - left(clip.first)) / span;
    if (!(per_number > 0)) return;
    const long long step = round_step(static_cast<double>(widest + space.gap) / per_number);
    long long small = small_step(step);
    if (static_cast<double>(small) * per_number < static_cast<double>(space.least_tick)) small = step;
    const auto round_below = [&](int at, long long of) {  // frames may be below 0
      return number(at) / of - (number(at) % of < 0 ? 1 : 0);
    };
    // Where only each seventh frame is there, the first from a round number on stands for it.
    const auto reaches = [&](int at, long long of) {
      return at == clip.first ? number(at) % of == 0 : round_below(at, of) != round_below(at - 1, of);
    };
    for (int at = clip.first; at < end; ++at) {
      if (!reaches(at, small)) continue;
      if (reaches(at, step))
        add_label(at);
      else
        out.push_back({.x = middle(at), .label = {}});
    }
  }
};

}  // namespace

std::vector<RulerTick> ruler_ticks(const Footage& footage, const RulerSpace& space) {
  Ruler ruler{footage, space};
  if (space.width > 0)
    for (const auto& clip : footage.clips()) ruler.add_clip(clip);
  return std::move(ruler.out);
}

}  // namespace afterglow
