// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "image/movie_source.h"
#include "image/sound.h"

namespace afterglow {

/// See SoundTrack::open. `start`: when the first picture shows, in seconds of the container's clock.
Result<std::unique_ptr<SoundTrack>> open_sound_with_ffmpeg(const MovieRequest& request, double start);

}  // namespace afterglow
