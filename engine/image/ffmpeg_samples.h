// SPDX-License-Identifier: MIT
// Decoded sound into other rates, channels and formats.
#pragma once

extern "C" {
#include <libswresample/swresample.h>
}

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>

#include "image/ffmpeg_handles.h"

namespace afterglow {

/// Seconds. A stamp beyond that is none: no sound lasts for years.
inline constexpr std::int64_t kFarthestSound = 1'000'000'000;

struct SwrDeleter {
  void operator()(SwrContext* converter) const { swr_free(&converter); }
};
using SwrHandle = std::unique_ptr<SwrContext, SwrDeleter>;

/// Files of floats hold anything.
template <class T>
T held_sample(T sample) {
  return std::isnan(sample) ? T{0} : std::clamp(sample, T{-1}, T{1});
}

/// The same for all samples of a frame that are floats. False: there is no memory.
bool hold_samples(AVFrame& frame);

/// Where `from_layout` says none it is the usual one for so many channels. Null: FFmpeg cannot.
SwrHandle converter_between(const AVFrame& from, const AVChannelLayout& from_layout, const AVChannelLayout& layout,
                            AVSampleFormat format, int rate);

}  // namespace afterglow
