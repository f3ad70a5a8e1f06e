// SPDX-License-Identifier: MIT
#pragma once

#include "image/ffmpeg_handles.h"

namespace afterglow {

/// What is to be added to the stamps of this stream, in samples. Decoders of Opus give some samples before the sound
/// begins, and readers of Matroska take their time off. FFmpeg adds it when it writes; before 7 it does not, and sound
/// would be 7 ms early.
std::int64_t missing_opus_delay(const AVOutputFormat& format, const AVCodecParameters& sound);

}  // namespace afterglow
