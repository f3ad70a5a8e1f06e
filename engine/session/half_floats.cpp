// SPDX-License-Identifier: MIT
#include "session/half_floats.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/half.h"

namespace afterglow {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();
/// Screens and overlays of what differs by a little, and masks that look at it.
constexpr double kComposite = 4;

double promised(const Promises& of, const char* kind, const char* number) {
  const auto found = std::ranges::find(of.invariants, kind, &Invariant::name);
  return found == of.invariants.end() ? kNone : found->numbers.at(number);
}

bool is_composed(const StackEntry& entry) {
  return entry.opacity != 1 || entry.blend != "normal" || entry.mask || entry.is_mix();
}

}  // namespace

HalfFloatPromise half_float_promise(const Build& build) {
  HalfFloatPromise out;
  double most = -1;  // the largest share so far
  const auto add = [&](double before, double share, std::string reason) {
    out.error = before + share;
    if (share <= most) return;
    most = share;
    out.reason = std::move(reason);
  };
  for (const auto& history : build.graph.histories)
    add(0, kNone, fmt::format("'{}' looks at the frame before", history.effect));
  struct Group {
    std::size_t end;
    double composite;
  };
  std::vector<Group> groups;  // that are open, the inner ones behind
  for (std::size_t i = 0; i < build.entries->size(); ++i) {
    // A group has no passes but those of its members and, behind them, its composite.
    for (; !groups.empty() && groups.back().end == i; groups.pop_back()) out.error *= groups.back().composite;
    const StackEntry& entry = (*build.entries)[i];
    const auto& skipped = build.graph.skipped;
    if (!entry.enabled || std::ranges::find(skipped, entry.name, &Skipped::name) != skipped.end()) {
      i += static_cast<std::size_t>(entry.members);
      continue;
    }
    const double composite = is_composed(entry) ? kComposite : 1;
    if (entry.members > 0) {
      groups.push_back({entry.end_of(i), composite});
      continue;
    }
    const bool asked = i < build.promises.size();
    const double own = asked ? promised(build.promises[i], "error", "fp16") : kNone;
    const double up_to = asked ? promised(build.promises[i], "error", "up_to") : 0;
    const double slope = asked ? promised(build.promises[i], "continuous", "slope") : kNone;
    const double before = out.error > 0 ? composite * out.error * std::max(1.0, slope) : 0;
    if (!std::isfinite(own))
      add(before, kNone, fmt::format("'{}' promises none", entry.name));
    else if (up_to < kMaxHalf)
      add(before, kNone, fmt::format("'{}' promises an error for light up to {:g} alone", entry.name, up_to));
    else if (!std::isfinite(slope) && before > 0)
      add(before, kNone, fmt::format("'{}' promises nothing about errors of what it is given", entry.name));
    else
      add(before, composite * own, fmt::format("'{}' promises an error of {:g}", entry.name, own));
  }
  for (const Group& group : groups) out.error *= group.composite;
  return out;
}

}  // namespace afterglow
