// SPDX-License-Identifier: MIT
#include "image/sound.h"

#include "image/ffmpeg_module.h"
#include "image/movie.h"
#include "image/movie_container.h"

namespace afterglow {

Result<std::unique_ptr<SoundTrack>> SoundTrack::open(const Movie& movie) {
  const std::string format = movie_format(movie.file());
  const MovieFacts& facts = movie.facts();
  if (format.empty() || facts.pts.empty()) return std::unique_ptr<SoundTrack>();
  AFTERGLOW_TRY(const FfmpegModule* module, ffmpeg_module());
  const double start = static_cast<double>(facts.pts.front()) * static_cast<double>(facts.time_base.numerator) /
                       static_cast<double>(facts.time_base.denominator);
  AFTERGLOW_TRY(const Patience patience, patience_of_process());
  return module->sound({movie.file(), format, {}, patience}, start, facts.clock);
}

}  // namespace afterglow
