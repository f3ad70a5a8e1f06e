// SPDX-License-Identifier: MIT
// What a stack promises when the images between its kernels are half floats: from what each of its effects promises.
#pragma once

#include <string>

#include "script/build.h"

namespace afterglow {

struct HalfFloatPromise {
  double error = 0;    ///< E of math.md §13, of the whole stack; infinite where an effect promises none
  std::string reason;  ///< "'glow' promises an error of 0.01": of the entry with the largest share; empty: nothing runs
};

/// An entry passes on the error of what it is given, times its promised slope (`continuous`), and adds its own
/// (`error.fp16`). Promises that end below what a half float holds (`up_to`) are none, as nobody knows the picture yet;
/// so are those of stacks with histories, whose errors add up from frame to frame.
HalfFloatPromise half_float_promise(const Build& build);

}  // namespace afterglow
