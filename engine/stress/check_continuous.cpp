// SPDX-License-Identifier: MIT
// The promise that nothing jumps.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "stress/check.h"

namespace afterglow::stress {
namespace {

/// The stack over a family of greys: those of the picture, lifted by `level`.
class Lifted {
 public:
  Lifted(Harness& harness, const Situation& s) : harness_(harness), s_(s), base_(greys_of(s)) {}
  Result<Image> at(double level) {
    Picture lifted = changed(base_);
    for (std::size_t i = 0; i < lifted.color.pixels.size(); ++i)
      if (i % 4 < 3) lifted.color.pixels[i] = static_cast<float>(base_.color.pixels[i] * 0.1 + level);
    AFTERGLOW_TRY(Made made, harness_.run(s_.look, lifted, s_.frame, usual_way(harness_)));
    return std::move(made.image);
  }
  float largest() const { return *std::ranges::max_element(base_.color.pixels); }

 private:
  Harness& harness_;
  const Situation& s_;
  Picture base_;
};

struct Step {
  double low, high;      ///< levels
  double change = 0;     ///< largest of any sample
  double magnitude = 0;  ///< of the sample there
  double excess(double slope) const { return change - slope * (high - low); }
};

Step step_between(double low, double high, const Image& a, const Image& b) {
  Step step{low, high};
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    if (i % 4 == 3) continue;
    const double change = std::abs(static_cast<double>(b.pixels[i]) - static_cast<double>(a.pixels[i]));
    if (!(change <= step.change)) {
      step.change = change;
      step.magnitude = std::max(std::abs(a.pixels[i]), std::abs(b.pixels[i]));
    }
  }
  return step;
}

/// The steps between `count` levels from `low` to `high`, each larger than the one before by a factor.
Result<std::vector<Step>> steps(Lifted& lifted, double low, double high, int count) {
  std::vector<Step> out;
  AFTERGLOW_TRY(Image before, lifted.at(low));
  double from = low;
  for (int i = 1; i <= count; ++i) {
    // What the device gets: floats.
    const double level = static_cast<float>(low * std::pow(high / low, static_cast<double>(i) / count));
    if (level <= from) continue;
    AFTERGLOW_TRY(Image after, lifted.at(level));
    out.push_back(step_between(from, level, before, after));
    before = std::move(after);
    from = level;
  }
  return out;
}

/// Looks closer and closer where the most happens: what is left of a jump when the step gets small.
Result<Outcome> continuous(Harness& harness, const Situation& s, const Invariant& hold) {
  constexpr int kFirst = 32, kCloser = 8, kZooms = 5;
  constexpr double kRounding = 4e-6;  // of two results, and of the sums that levels are
  const double slope = hold.numbers.at("slope");
  Lifted lifted(harness, s);
  AFTERGLOW_TRY(std::vector<Step> found, steps(lifted, 1e-3, 100, kFirst));
  Step worst{};
  for (int zoom = 0; zoom <= kZooms && !found.empty(); ++zoom) {
    worst = *std::ranges::max_element(found, {}, [&](const Step& step) { return step.excess(slope); });
    if (zoom == kZooms) break;
    AFTERGLOW_TRY(found, steps(lifted, worst.low, worst.high, kCloser));
  }
  const double rounding = kRounding * (worst.magnitude + slope * (worst.high + lifted.largest()) + 0.01);
  return within_bound(
      worst.change, slope * (worst.high - worst.low) + rounding,
      fmt::format("between the levels {:.9g} and {:.9g} the result changes by {:.3g}: more than {:g} times as much",
                  worst.low, worst.high, worst.change, slope));
}

constexpr long long kSmall = 4096;

constexpr Check kContinuousChecks[] = {
    {"continuous", "continuous", "no jump where light changes by a little", continuous, kSmall},
};

}  // namespace

std::span<const Check> continuous_checks() { return kContinuousChecks; }

}  // namespace afterglow::stress
