// SPDX-License-Identifier: MIT
// Videos: containers, the index of their frames, decoders, from samples to light.
#include "image/movie.h"

#include <algorithm>
#include <cmath>

#include "fuzz.h"
#include "image/reader.h"

using namespace afterglow;

namespace {
constexpr SizeLimits kSmall{.max_side = 512, .max_bytes = 64ull << 20};
constexpr int kMostFrames = 6;
}  // namespace

/// Modules take seconds to load under the sanitizers: not in the time of an input.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  Diagnostics quiet;
  (void)Movie::open(fuzz::write("tiny.y4m", "YUV4MPEG2 W2 H2 F24:1\nFRAME\n123456"), kSmall, quiet);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = fuzz::write("clip", fuzz::text_of(data, size));
  Diagnostics quiet;
  if (movie_format(file).empty()) return 0;
  auto movie = Movie::open(file, kSmall, quiet);
  if (!movie) {
    fuzz::check_error(movie.error(), {ErrorKind::io});
    return 0;
  }
  FUZZ_CLAIM((*movie)->frames() > 0, "");
  const int last = (*movie)->frames() - 1;
  ReadOptions options;
  options.movie = *movie;
  options.max_side = kSmall.max_side;
  options.max_bytes = kSmall.max_bytes;
  for (int i = 0; i <= std::min(last, kMostFrames); ++i) {
    options.movie_frame = i < kMostFrames ? i : last;
    FUZZ_CLAIM(std::isfinite((*movie)->time(options.movie_frame)), "");
    const auto picture = read_picture(file, options, quiet);
    if (!picture) {
      fuzz::check_error(picture.error(), {ErrorKind::io});
      continue;
    }
    for (const float v : picture->color.pixels) FUZZ_CLAIM(std::isfinite(v) && v >= 0, "");
  }
  return 0;
}
