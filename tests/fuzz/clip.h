// SPDX-License-Identifier: MIT
// What the harnesses of videos share.
#pragma once

#include "fuzz.h"
#include "image/movie.h"

namespace afterglow::fuzz {

inline constexpr SizeLimits kSmallClips{.max_side = 512, .max_bytes = 64ull << 20};

}  // namespace afterglow::fuzz

/// Modules take seconds to load under the sanitizers: not in the time of an input.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  afterglow::Diagnostics quiet;
  (void)afterglow::Movie::open(afterglow::fuzz::write("tiny.y4m", "YUV4MPEG2 W2 H2 F24:1\nFRAME\n123456"),
                               afterglow::fuzz::kSmallClips, quiet);
  return 0;
}
