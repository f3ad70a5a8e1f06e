// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "core/text.h"
#include "script/schema.h"

namespace afterglow {
namespace {

constexpr double kNeeded = std::numeric_limits<double>::quiet_NaN();
/// Nothing limits it: pictures hold at most this.
constexpr double kAny = 1e30;

}  // namespace

const std::vector<InvariantKind>& invariant_kinds() {
  static const std::vector<InvariantKind> kinds{
      {"black", "within", {{"within", 0}}, {}, "A black picture stays black."},
      {"constant", "within", {{"within", 1e-5}}, {}, "A picture of one colour stays of one colour."},
      {"mean",
       "within",
       {{"within", kNeeded}, {"margin", 0}},
       {},
       "The mean of each channel stays, when nothing but black lies within `margin` pixels of the edges."},
      {"no_added_light",
       "within",
       {{"within", kNeeded}, {"margin", 0}},
       {},
       "The mean of a grey picture does not grow, with the same `margin`."},
      {"monotone",
       "within",
       {{"within", 1e-5}},
       {},
       "Of two grey pictures of which one is nowhere darker, its result is nowhere darker."},
      {"bounded",
       "to",
       {{"from", kNeeded}, {"to", kNeeded}, {"within", 1e-5}},
       {},
       "Results of grey pictures lie between `from` and `to`; without them, between the least and the largest value of "
       "the picture."},
      {"continuous",
       "slope",
       {{"slope", kNeeded}},
       {},
       "Where a grey picture changes by a little everywhere, the result changes by at most `slope` times as much."},
      {"linear",
       "within",
       {{"within", 1e-5}, {"up_to", kAny}},
       {},
       "The result of a sum of pictures is the sum of their results, as long as no value is above `up_to`."},
      {"proportional",
       "setting",
       {{"within", 1e-5}, {"up_to", kNeeded}},
       {"setting"},
       "What the effect adds is proportional to `setting`, up to `up_to`."},
      {"mirror",
       "within",
       {{"within", 1e-5}},
       {},
       "A picture that is mirrored, either way, gives the mirrored result."},
      {"turn_180",
       "within",
       {{"within", 1e-5}},
       {},
       "A picture that is turned by 180 degrees gives the turned result."},
      {"turn_90",
       "within",
       {{"within", 1e-5}, {"margin", 0}},
       {},
       "The same for 90 degrees, when nothing but black lies within `margin` pixels of the edges."},
      {"shift",
       "by",
       {{"by", kNeeded}, {"margin", 0}, {"within", 1e-5}},
       {},
       "A picture that is moved by a multiple of `by` pixels gives the moved result, when nothing but black lies "
       "within "
       "`margin` pixels of the edges before and behind."},
      {"error",
       "fp32",
       {{"fp32", 1e-5}, {"fp16", 2e-3}, {"up_to", kAny}},
       {"levels"},
       "The error against double precision, in full floats and with images in half floats, for pictures up to `up_to`. "
       "`levels` names the setting that says how many levels a pyramid has."},
  };
  return kinds;
}

std::string invariant_text(const InvariantSchema& hold) {
  std::vector<std::string> parts;
  for (const auto& [name, setting] : hold.stated.settings) parts.push_back(fmt::format("{} {}", name, setting));
  for (const auto& [name, value] : hold.stated.numbers)
    if (std::isfinite(value) && value != kAny) parts.push_back(fmt::format("{} {:g}", name, value));
  for (const auto& name : hold.computed) parts.push_back(name + " by settings");
  if (hold.conditional) parts.emplace_back("for some settings");
  return parts.empty() ? hold.stated.name : fmt::format("{} ({})", hold.stated.name, join(parts, "; "));
}

}  // namespace afterglow
