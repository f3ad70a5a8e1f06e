// SPDX-License-Identifier: MIT
// Plays the sound of a video and says which moment of it is heard: the clock that pictures follow.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>

#include "image/movie.h"
#include "play/sound_device.h"

namespace afterglow {

/// Null: the video has none.
using OpenSoundTrack = std::function<Result<std::unique_ptr<SoundTrack>>()>;

struct SoundOptions {
  bool mute = false;
  double volume = 1;            ///< 0 to 1: what samples are multiplied by
  OpenSoundDevice open_device;  ///< empty: `open_sound_device`
};

/// A part of a track that is played again and again, in seconds: behind its end its beginning is heard, without a gap.
struct SoundLoop {
  double from = 0, until = 0;
  friend bool operator==(const SoundLoop&, const SoundLoop&) = default;
};

/// Thread-safe. Tracks and device are used by a thread of its own, which begins with the first sound.
class Sound {
 public:
  /// `clock`: seconds, of the clock that `heard` is asked by; any thread. `tell`: called once, on any thread, when
  /// sound cannot be heard.
  Sound(SoundOptions options, std::function<double()> clock, std::function<void(const std::string&)> tell);
  ~Sound();
  Sound(const Sound&) = delete;
  Sound& operator=(const Sound&) = delete;

  /// From now on the track `key` is heard from `seconds` on; `open` makes it when it is another one than before.
  void play(const std::string& key, double seconds, const OpenSoundTrack& open);
  void stop();
  /// From now on; what has been written ahead stays. None, or one that is shorter than 0.05 s: there is no loop.
  void set_loop(const std::optional<SoundLoop>& loop);
  /// The moment of the track that is heard at `now`, in seconds. None: nothing is playing, or it has not begun.
  std::optional<double> heard(double now) const;
  /// What `play` was given last; empty: nothing plays.
  std::string playing() const;

  bool mute() const;
  void set_mute(bool mute);
  double volume() const;
  void set_volume(double volume);  ///< held in 0…1
  /// Why there will be no sound; empty: nothing is known against it.
  std::string failure() const;

 private:
  struct Wish {
    std::uint64_t number = 0;    ///< grows with each
    std::string key;             ///< empty: silence
    double seconds = 0, at = 0;  ///< from that moment on, when it was wished
    OpenSoundTrack open;
  };
  void run();
  bool begin(const Wish& wish);
  bool write_some(const Wish& wish);
  Result<void> read_on(std::span<float> samples, const std::optional<SoundLoop>& loop);
  void fail(const std::string& why, bool for_good);

  SoundOptions options_;
  std::function<double()> clock_;
  std::function<void(const std::string&)> tell_;

  mutable std::mutex mutex_;
  std::condition_variable woken_;
  bool ends_ = false, told_ = false, broken_ = false;
  Wish wish_;
  std::string failure_;
  struct Moment {
    std::uint64_t wish = 0;
    double seconds = 0, at = 0;
    std::optional<SoundLoop> loop;  ///< what is written ahead has come around it
  };
  std::optional<SoundLoop> loop_;
  std::optional<Moment> moment_;

  // Of the thread.
  std::unique_ptr<SoundDevice> device_;
  std::unique_ptr<SoundTrack> track_;
  std::string track_key_;
  std::int64_t cursor_ = 0;          ///< the next frame of samples to be written
  std::optional<SoundLoop> around_;  ///< that `cursor_` went around last
  std::int64_t since_ = 0;           ///< frames of samples that were written since
  float gain_ = 0;                   ///< of the last sample
  struct Pace {
    double at = 0, frames = 0;
    bool by_clock = false;  ///< the device has none
  } pace_;
  std::thread thread_;
};

}  // namespace afterglow
