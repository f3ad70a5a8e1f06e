// SPDX-License-Identifier: MIT
// Where sound goes: ALSA, in a module of its own that is loaded when the first sound is to be heard. A build without
// it (AFTERGLOW_SOUND=OFF) says so.
#pragma once

#include <functional>
#include <memory>
#include <span>

#include "core/result.h"

namespace afterglow {

/// Takes samples as SoundTrack gives them. One thread at a time.
class SoundDevice {
 public:
  virtual ~SoundDevice() = default;
  /// Waits until there is room for all of them. A device that has run dry goes on with these. Errors: device (gone).
  virtual Result<void> write(std::span<const float> samples) = 0;
  /// Frames of samples that were written and have not been heard yet.
  virtual double delay() = 0;
  /// What has not been heard is forgotten.
  virtual void drop() = 0;
};

using OpenSoundDevice = std::function<Result<std::unique_ptr<SoundDevice>>()>;

/// The user's default device. Errors: device (there is none, it is taken), io (the module is not installed).
Result<std::unique_ptr<SoundDevice>> open_sound_device();

}  // namespace afterglow
