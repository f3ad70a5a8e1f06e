// SPDX-License-Identifier: MIT
// The sound of a video, sample by sample: any of them is the one that playing from the beginning comes to, as exactly
// as the container's stamps say (half a millisecond in Matroska, half a sample in MP4 and QuickTime).
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "core/result.h"

namespace afterglow {

class Movie;

/// Two channels at one rate, whatever the file has. One thread at a time.
class SoundTrack {
 public:
  static constexpr int kRate = 48000;  ///< frames of samples a second
  static constexpr int kChannels = 2;  ///< left, right

  virtual ~SoundTrack() = default;
  /// Samples from frame `first` on, counted from when the video's first picture shows, −1 to 1, left and right in turn;
  /// zeros before the sound begins and behind its end. In order they are cheap. `to` holds whole frames of samples.
  /// Errors: io (the file cannot be read; what a decoder cannot take is silent).
  virtual Result<void> read(std::int64_t first, std::span<float> to) = 0;

  /// The sound that the container calls the best. Null: it has none. Errors: io (no such file, a codec that is not
  /// read, built without FFmpeg).
  static Result<std::unique_ptr<SoundTrack>> open(const Movie& movie);
};

}  // namespace afterglow
