// SPDX-License-Identifier: MIT
// What is tested of every effect alike: settings beside what the oracle makes of them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness.h"

namespace afterglow {

struct EffectCase {
  std::string entries;  ///< Lua, as `run_stack` takes it
  std::function<reference::DoubleImage(const Scene&)> oracle;
};

struct Tolerances {
  double full = kFullFloat, fused = kFused, half = kHalfFloat;
  bool spikes = true;  ///< pictures with single pixels at 1e4 too
};

/// Positions between pixels are sums of floats: one near 240 is known to 2^-17, and random neighbours differ by factors
/// of hundreds.
inline constexpr Tolerances kBetweenPixels{.full = 5e-4, .fused = 5e-5, .half = kHalfFloat, .spikes = false};
/// Steep curves: where they start, what is rounded before them grows.
inline constexpr Tolerances kSteep{.full = 1e-4, .fused = 1e-5, .half = kHalfFloat};
/// Decisions by comparing: a rounding may turn one, and those of half floats turn many.
inline constexpr Tolerances kDecisions{.full = 1e-3, .fused = 1e-4, .half = 1, .spikes = false};

/// Random pictures of every size and a real one: plain passes against the oracle, fused against plain, half floats
/// against the oracle; alpha is kept.
void agree_everywhere(const std::vector<EffectCase>& cases, const Tolerances& tolerances = {});

/// The effect does not run, for this reason: the picture stays bit for bit.
void expect_skipped(const std::string& entries, const std::string& reason);

}  // namespace afterglow
