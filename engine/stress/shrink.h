// SPDX-License-Identifier: MIT
// Makes a situation smaller for as long as it fails in the same check.
#pragma once

#include <functional>

#include "stress/check.h"

namespace afterglow::stress {

/// Does it still fail?
using StillFails = std::function<bool(const Situation&)>;

struct Shrunk {
  Situation situation;
  int tries = 0;
};

/// Leaves out entries, puts settings back to their defaults one by one, cuts the picture, blackens parts of it; again,
/// until nothing can go. At most `most_tries` calls of `fails`.
Shrunk shrink(Situation situation, const StillFails& fails, int most_tries = 200);

}  // namespace afterglow::stress
