// SPDX-License-Identifier: MIT
// The truth that errors are measured against.
#pragma once

#include <string>
#include <vector>

#include "image/picture.h"
#include "reference/stack.h"
#include "script/build.h"

namespace afterglow::bench {

/// The entries of a preset that run, as the oracle wants them. `graph`: of the same preset; effects that it skipped are
/// left out.
std::vector<reference::Entry> oracle_entries(const Build& build);

/// R, G and B of the stack's result in double precision. Every effect must have an oracle. `frame`: the picture's
/// number in its sequence, which plays as fast as usual.
std::vector<double> oracle_result(const Picture& picture, const std::vector<reference::Entry>& entries,
                                  double frame = 1);

}  // namespace afterglow::bench
