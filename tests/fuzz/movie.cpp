// SPDX-License-Identifier: MIT
// Videos: containers, the index of their frames, decoders, from samples to light.
#include "image/movie.h"

#include <algorithm>
#include <cmath>

#include "clip.h"
#include "image/reader.h"

using namespace afterglow;

namespace {
constexpr int kMostFrames = 6;
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = fuzz::write("clip", fuzz::text_of(data, size));
  Diagnostics quiet;
  if (movie_format(file).empty()) return 0;
  auto movie = Movie::open(file, fuzz::kSmallClips, quiet);
  if (!movie) {
    fuzz::check_error(movie.error(), {ErrorKind::io});
    return 0;
  }
  FUZZ_CLAIM((*movie)->frames() > 0, "");
  const int last = (*movie)->frames() - 1;
  ReadOptions options;
  options.movie = *movie;
  options.max_side = fuzz::kSmallClips.max_side;
  options.max_bytes = fuzz::kSmallClips.max_bytes;
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
