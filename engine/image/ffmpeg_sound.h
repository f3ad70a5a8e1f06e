// SPDX-License-Identifier: MIT
#pragma once

extern "C" {
#include <libavcodec/codec.h>
}

#include <memory>
#include <vector>

#include "image/clock_part.h"
#include "image/movie_source.h"
#include "image/sound.h"

namespace afterglow {

/// One that strangers' files may reach.
bool is_sound_decoder(const AVCodec& codec);

/// See SoundTrack::open. `start`: when the first picture shows, in seconds of the container's clock. `clock`:
/// where that one starts anew.
Result<std::unique_ptr<SoundTrack>> open_sound_with_ffmpeg(const MovieRequest& request, double start,
                                                           const std::vector<ClockPart>& clock);

}  // namespace afterglow
