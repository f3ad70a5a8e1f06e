// SPDX-License-Identifier: MIT
#include "play/sound_device.h"

#include "core/module.h"

namespace afterglow {

Result<std::unique_ptr<SoundDevice>> open_sound_device() {
#ifdef AFTERGLOW_HAS_SOUND
  auto entry = load_module("afterglow_alsa.so", "afterglow_alsa_open");
  if (!entry) return std::move(entry).error();
  return reinterpret_cast<Result<std::unique_ptr<SoundDevice>> (*)()>(*entry)();
#else
  return Error{ErrorKind::io, "this Afterglow was built without sound"};
#endif
}

}  // namespace afterglow
