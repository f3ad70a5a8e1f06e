// SPDX-License-Identifier: MIT
#include "play/sound.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <utility>

#include "core/exception.h"

namespace afterglow {
namespace {

constexpr int kSoundBlock = SoundTrack::kRate / 100;  // frames of samples that are written at a time
constexpr double kAhead = 0.2 * SoundTrack::kRate;
/// No device is further off than this. One that takes everything at once (a file, nothing at all) is held to the clock.
constexpr double kFastest = 1.01;
constexpr double kShortestLoop = 0.05;

std::string without_sound(const Error& error) {
  return "there is no sound: " + (error.file.empty() ? "" : error.file + ": ") + error.message;
}

}  // namespace

Sound::Sound(SoundOptions options, std::function<double()> clock, std::function<void(const std::string&)> tell)
    : options_(std::move(options)), clock_(std::move(clock)), tell_(std::move(tell)) {
  if (!options_.open_device) options_.open_device = open_sound_device;
  set_volume(options_.volume);
}

Sound::~Sound() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  woken_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void Sound::play(const std::string& key, double seconds, const OpenSoundTrack& open) {
  const std::lock_guard lock(mutex_);
  if (broken_) return;
  wish_ = {wish_.number + 1, key, seconds, clock_(), open};
  moment_.reset();
  if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
  woken_.notify_all();
}

void Sound::stop() {
  const std::lock_guard lock(mutex_);
  if (wish_.key.empty()) return;
  wish_ = {wish_.number + 1, {}, 0, 0, {}};
  moment_.reset();
  woken_.notify_all();
}

void Sound::set_loop(const std::optional<SoundLoop>& loop) {
  const std::lock_guard lock(mutex_);
  loop_ = loop && loop->until - loop->from >= kShortestLoop ? loop : std::nullopt;
}

std::optional<double> Sound::heard(double now) const {
  const std::lock_guard lock(mutex_);
  if (!moment_ || moment_->wish != wish_.number) return std::nullopt;
  const double seconds = moment_->seconds + (now - moment_->at);
  const auto& loop = moment_->loop;
  return loop && seconds >= loop->until ? seconds - (loop->until - loop->from) : seconds;
}

std::string Sound::playing() const {
  const std::lock_guard lock(mutex_);
  return wish_.key;
}

bool Sound::mute() const {
  const std::lock_guard lock(mutex_);
  return options_.mute;
}

void Sound::set_mute(bool mute) {
  const std::lock_guard lock(mutex_);
  options_.mute = mute;
}

double Sound::volume() const {
  const std::lock_guard lock(mutex_);
  return options_.volume;
}

void Sound::set_volume(double volume) {
  const std::lock_guard lock(mutex_);
  options_.volume = std::isfinite(volume) ? std::clamp(volume, 0.0, 1.0) : 1;
}

std::string Sound::failure() const {
  const std::lock_guard lock(mutex_);
  return failure_;
}

/// A track that cannot be read leaves the others; without a device nothing will be heard.
void Sound::fail(const std::string& why, bool for_good) {
  bool first = false;
  {
    const std::lock_guard lock(mutex_);
    failure_ = why;
    broken_ = broken_ || for_good;
    first = !std::exchange(told_, true);
  }
  if (first && tell_) tell_(why);
}

void Sound::run() {
  std::uint64_t taken = 0;
  bool sounds = false;
  while (true) {
    Wish wish;
    {
      std::unique_lock lock(mutex_);
      if (!sounds) woken_.wait(lock, [&] { return ends_ || wish_.number != taken; });
      if (ends_) return;
      wish = wish_;
    }
    if (wish.number != taken) {
      taken = wish.number;
      if (device_) device_->drop();
      sounds = begin(wish);
    }
    if (sounds) sounds = write_some(wish);
  }
}

bool Sound::begin(const Wish& wish) {
  if (wish.key.empty()) return false;
  if (track_key_ != wish.key) {
    track_key_ = wish.key;
    auto opened = without_exceptions(wish.open);
    track_ = opened ? std::move(opened).value() : nullptr;
    if (!opened) fail(without_sound(opened.error()), false);
  }
  if (!track_) return false;
  if (!device_) {
    auto opened = without_exceptions(options_.open_device);
    if (!opened) {
      fail(without_sound(opened.error()), true);
      return false;
    }
    device_ = std::move(opened).value();
  }
  // Opening took its time: it goes on where the picture is by now.
  cursor_ = std::llround((wish.seconds + clock_() - wish.at) * SoundTrack::kRate);
  around_.reset();
  gain_ = 0;  // without a click
  pace_ = {clock_(), kAhead};
  return true;
}

/// From `cursor_` on, around the loop's end where that lies ahead.
Result<void> Sound::read_on(std::span<float> samples, const std::optional<SoundLoop>& loop) {
  const auto frame_at = [](double seconds) { return std::llround(seconds * SoundTrack::kRate); };
  while (!samples.empty()) {
    auto frames = static_cast<std::int64_t>(samples.size()) / SoundTrack::kChannels;
    const std::int64_t until = loop ? frame_at(loop->until) : 0;
    if (loop && cursor_ < until) frames = std::min(frames, until - cursor_);
    const std::size_t count = static_cast<std::size_t>(frames) * SoundTrack::kChannels;
    AFTERGLOW_CHECK(track_->read(cursor_, samples.first(count)));
    samples = samples.subspan(count);
    cursor_ += frames;
    since_ += frames;
    if (!loop || cursor_ != until) continue;
    cursor_ = frame_at(loop->from);
    around_ = loop;
    since_ = 0;
  }
  return {};
}

/// One block; false: the device is gone.
bool Sound::write_some(const Wish& wish) {
  const double now = clock_();
  const double fastest = pace_.by_clock ? 1 : kFastest;
  pace_.frames = std::min(kAhead, pace_.frames + (now - pace_.at) * fastest * SoundTrack::kRate);
  pace_.at = now;
  if (pace_.frames < kSoundBlock) {
    std::unique_lock lock(mutex_);
    const double wait = (kSoundBlock - pace_.frames) / SoundTrack::kRate;
    woken_.wait_for(lock, std::chrono::duration<double>(std::clamp(wait, 1e-3, 1e-2)),
                    [&] { return ends_ || wish_.number != wish.number; });
    return true;
  }
  std::array<float, std::size_t{kSoundBlock} * SoundTrack::kChannels> samples{};
  float gain = 0;
  std::optional<SoundLoop> loop;
  {
    const std::lock_guard lock(mutex_);
    loop = loop_;
    gain = options_.mute ? 0 : static_cast<float>(options_.volume);
  }
  if (auto read = without_exceptions([&] { return read_on(samples, loop); }); !read) {
    fail(without_sound(read.error()), false);
    return false;
  }
  const float step = (gain - gain_) / kSoundBlock;
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i] *= gain == gain_ ? gain : gain_ + step * static_cast<float>(i / SoundTrack::kChannels + 1);
  gain_ = gain;
  if (auto written = device_->write(samples); !written) {
    fail(without_sound(written.error()), true);
    return false;
  }
  pace_.frames -= kSoundBlock;
  // Devices that take everything at once say that nothing waits. What is written ahead of the clock is not heard yet.
  const double said = device_->delay(), written_at = clock_();
  const double ahead = kAhead - pace_.frames - (written_at - now) * SoundTrack::kRate, delay = std::max(said, ahead);
  pace_.by_clock = ahead > said + 2 * kSoundBlock;
  double seconds = (static_cast<double>(cursor_) - delay) / SoundTrack::kRate;
  // What was written before the loop's beginning is heard up to its end.
  const bool before = around_ && delay > static_cast<double>(since_);
  if (before) seconds += around_->until - around_->from;
  const std::lock_guard lock(mutex_);
  moment_ = {wish.number, seconds, written_at, before ? around_ : std::nullopt};
  return true;
}

}  // namespace afterglow
