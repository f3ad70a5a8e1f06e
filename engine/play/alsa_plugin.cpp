// SPDX-License-Identifier: MIT
// The module's one symbol.
#include <alsa/asoundlib.h>

#include <algorithm>
#include <string>

#include "core/module_shapes.h"
#include "image/movie.h"
#include "play/sound_device.h"

namespace afterglow {
namespace {

constexpr unsigned kLatency = 100'000;  // microseconds that the device holds

void say_nothing(const char*, int, const char*, int, const char*, ...) {}

class AlsaDevice : public SoundDevice {
 public:
  Result<void> open() {
    snd_lib_error_set_handler(say_nothing);  // what matters comes back as an error
    int done = snd_pcm_open(&pcm_, "default", SND_PCM_STREAM_PLAYBACK, 0);
    if (done >= 0)
      done = snd_pcm_set_params(pcm_, SND_PCM_FORMAT_FLOAT, SND_PCM_ACCESS_RW_INTERLEAVED, SoundTrack::kChannels,
                                SoundTrack::kRate, 1, kLatency);
    if (done < 0) return Error{ErrorKind::device, std::string("ALSA's device 'default': ") + snd_strerror(done)};
    return {};
  }
  ~AlsaDevice() override {
    if (pcm_) snd_pcm_close(pcm_);
  }

  Result<void> write(std::span<const float> samples) override {
    const float* from = samples.data();
    auto left = static_cast<snd_pcm_uframes_t>(samples.size()) / SoundTrack::kChannels;
    for (int failures = 0; left > 0;) {
      snd_pcm_sframes_t done = snd_pcm_writei(pcm_, from, left);
      if (done < 0) {
        const int recovered = snd_pcm_recover(pcm_, static_cast<int>(done), 1);
        constexpr int kMost = 3;
        if (recovered < 0 || ++failures > kMost)
          return Error{ErrorKind::device, std::string("ALSA: ") + snd_strerror(static_cast<int>(done))};
        continue;
      }
      from += done * SoundTrack::kChannels;
      left -= static_cast<snd_pcm_uframes_t>(done);
    }
    return {};
  }

  double delay() override {
    snd_pcm_sframes_t frames = 0;
    return snd_pcm_delay(pcm_, &frames) < 0 ? 0 : static_cast<double>(std::max<snd_pcm_sframes_t>(frames, 0));
  }

  void drop() override {
    snd_pcm_drop(pcm_);
    snd_pcm_prepare(pcm_);
  }

 private:
  snd_pcm_t* pcm_ = nullptr;
};

}  // namespace
}  // namespace afterglow

extern "C" __attribute__((visibility("default"))) afterglow::Result<std::unique_ptr<afterglow::SoundDevice>>
afterglow_alsa_open() {
  auto device = std::make_unique<afterglow::AlsaDevice>();
  AFTERGLOW_CHECK(device->open());
  return std::unique_ptr<afterglow::SoundDevice>(std::move(device));
}

AFTERGLOW_MODULE_SHAPES
