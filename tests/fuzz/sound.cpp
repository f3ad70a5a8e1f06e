// SPDX-License-Identifier: MIT
// The sound of videos: decoders, stamps of strangers' containers, seeking, the way to two channels at one rate.
#include "image/sound.h"

#include <array>
#include <cmath>

#include "clip.h"

using namespace afterglow;

namespace {

constexpr std::size_t kRead = 2400;  ///< frames of samples: a picture's at 20 a second
/// In order, a jump that is decoded on the way, one that is sought, back, and where no video is.
constexpr std::array<std::int64_t, 8> kFirst{0, kRead, 2 * kRead, 60'000, 480'000, 1'000, -5'000, 48'000ll * 86'400};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = fuzz::write("clip", fuzz::text_of(data, size));
  Diagnostics quiet;
  if (movie_format(file).empty()) return 0;
  const auto movie = Movie::open(file, fuzz::kSmallClips, quiet);
  if (!movie) return 0;  // the harness "movie" looks at that
  const auto sound = SoundTrack::open(**movie);
  if (!sound) {
    fuzz::check_error(sound.error(), {ErrorKind::io});
    return 0;
  }
  if (!*sound) return 0;
  std::vector<float> samples(kRead * SoundTrack::kChannels);
  for (const std::int64_t first : kFirst) {
    samples.assign(samples.size(), 9);
    if (const auto read = (*sound)->read(first, samples); !read) {
      fuzz::check_error(read.error(), {ErrorKind::io});
      continue;
    }
    for (const float v : samples) FUZZ_CLAIM(v >= -1 && v <= 1, std::to_string(v));
  }
  return 0;
}
