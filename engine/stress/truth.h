// SPDX-License-Identifier: MIT
// Results in double precision, and how far those of a device are from them.
#pragma once

#include <optional>
#include <vector>

#include "image/metrics.h"
#include "image/picture.h"
#include "stress/harness.h"

namespace afterglow::stress {

/// R, G and B of the stack's result by engine/reference; nothing when an effect of it has no oracle there.
std::optional<std::vector<double>> truth_of(const LookFacts& facts, const Picture& picture, double frame);

/// How far a result is from it. Values beyond kLargestColor, or with `half` beyond what half floats hold, count as
/// held there.
ErrorMeasure error_against(const Image& image, std::vector<double> truth, bool half);

/// Can the source itself be held in half floats without loss?
bool exact_in_halves(const Image& rgba);

}  // namespace afterglow::stress
