// SPDX-License-Identifier: MIT
// What a stream and its first frame say of the pictures.
#pragma once

#include <string>

#include "image/ffmpeg_input.h"
#include "image/ffmpeg_planes.h"
#include "image/movie_source.h"

namespace afterglow {

/// Everything but what an index knows.
MovieFacts facts_of(FfmpegInput& input, const AVFrame& first);
/// What the container says of its first frame, as text; empty: nothing.
std::string first_time_code(const AVFormatContext& container);
/// How this frame's samples are meant, where it does not say as `facts` are.
FramePlanes planes_of(const AVFrame& frame, const MovieFacts& facts);

}  // namespace afterglow
