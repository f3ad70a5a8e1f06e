// SPDX-License-Identifier: MIT
// What is measured in turns.
#pragma once

#include <functional>
#include <vector>

#include "bench/statistics.h"
#include "core/result.h"

namespace afterglow::bench {

/// Something that can be run again and again, and how many milliseconds that took.
using Measured = std::function<Result<double>()>;

/// Runs each once to warm up, then all of them in turns, `repeat` rounds, each round beginning with another one, so
/// that what disturbs the machine for a while disturbs all alike. `step` is called before each round (the warm-up is
/// round 0) and may end it with an error. Returns one spread each.
Result<std::vector<Spread>> run_in_turns(const std::vector<Measured>& all, int repeat,
                                         const std::function<Result<void>(int round)>& step);

}  // namespace afterglow::bench
