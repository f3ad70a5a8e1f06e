// SPDX-License-Identifier: MIT
// The sound of clips: samples are those of a decode from the beginning, pictures follow them, and what reaches ALSA is
// what belongs there.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <random>

#include "clips.h"
#include "core/file.h"
#include "image/sound.h"
#include "play/sound_follower.h"

namespace afterglow {
namespace {

constexpr int kRate = SoundTrack::kRate;

/// Left counts samples up to 30,000 and begins anew, right is half of it.
const std::string kCounting = "-f lavfi -i \"aevalsrc=mod(n\\,30000)/32768|mod(n\\,30000)/65536:s=48000\" ";
/// Noise: no two places of it are alike. Without high tones, so that half a sample makes no great difference.
const std::string kNoise = "-f lavfi -i \"anoisesrc=r=48000:a=0.9:seed=3,lowpass=f=800,lowpass=f=800\" ";
/// Samples of the half millisecond that stamps of Matroska are off by, at most, at either end.
constexpr int kStampRound = 49;

std::vector<float> samples_of(SoundTrack& track, std::int64_t first, int frames) {
  std::vector<float> out(static_cast<std::size_t>(frames) * SoundTrack::kChannels);
  const auto read = track.read(first, out);
  EXPECT_TRUE(read) << read.error().text();
  return out;
}

/// Of `some` and that place of `all`, or one near it, which is as far off as stamps are.
float least_difference(const std::vector<float>& some, const std::vector<float>& all, std::size_t place, int lag) {
  float least = 1;
  for (int by = -lag; by <= lag; ++by) {
    const std::ptrdiff_t from = (static_cast<std::ptrdiff_t>(place) + by) * SoundTrack::kChannels;
    if (from < 0 || from + static_cast<std::ptrdiff_t>(some.size()) > static_cast<std::ptrdiff_t>(all.size())) continue;
    float most = 0;
    for (std::size_t i = 0; i < some.size(); ++i)
      most = std::max(most, std::abs(some[i] - all[static_cast<std::size_t>(from) + i]));
    least = std::min(least, most);
  }
  return least;
}

class Sounds : public Clips {
 protected:
  /// A clip of 24 frames a second with sound: `sound` are inputs of the program ffmpeg, `codec` what follows them.
  std::string sounding(const std::string& name, const std::string& sound, const std::string& codec, int seconds) {
    ffmpeg(fmt::format("-f lavfi -i color=c=gray:s=64x36:r=24:d={0} {1} -map 0:v -map 1:a {2} -t {0} \"{3}\"", seconds,
                       sound, codec, path(name)));
    return path(name);
  }
  std::unique_ptr<SoundTrack> track_of(const std::string& file) {
    movies_.push_back(open(file));
    auto track = SoundTrack::open(*movies_.back());
    EXPECT_TRUE(track) << track.error().text();
    return track ? std::move(track).value() : nullptr;
  }
  std::vector<std::shared_ptr<Movie>> movies_;
};

TEST_F(Sounds, EverySampleIsWhereItBelongs) {
  for (const char* name : {"a.mov", "b.mkv", "c.avi"}) {
    const auto track = track_of(sounding(name, kCounting, "-c:v mjpeg -c:a pcm_s16le", 6));
    ASSERT_TRUE(track) << name;
    const float off = name == std::string("b.mkv") ? kStampRound / 32768.0f : 0;
    for (const std::int64_t first : {0, 1, 100'000, 250'000, 99'999, 480, 287'000}) {
      const auto samples = samples_of(*track, first, 480);
      for (std::size_t i = 0; i < 480; ++i) {
        const auto expected = static_cast<float>((first + static_cast<std::int64_t>(i)) % 30'000) / 32768;
        ASSERT_NEAR(samples[2 * i], expected, 1e-4 + off) << name << " " << first << "+" << i;
        ASSERT_NEAR(samples[2 * i + 1], samples[2 * i] / 2, 1e-4) << name << " " << first << "+" << i;
      }
    }
    for (const float sample : samples_of(*track, 6 * kRate + 4800, 480)) EXPECT_EQ(sample, 0) << "behind the end";
    for (const float sample : samples_of(*track, -4800, 480)) EXPECT_EQ(sample, 0) << "before the beginning";
  }
}

/// Joined MPEG streams, whose stamps go back where they meet: in order and after jumps.
TEST_F(Sounds, GoOnWhereAClockStartsAnew) {
  constexpr int kPart = 2, kParts = 3, kBlock = 480;
  const std::string part = sounding("part.ts", kNoise, "-c:v mpeg2video -c:a mp2 -b:a 384k", kPart);
  ASSERT_EQ(std::system(fmt::format("cat \"{0}\" \"{0}\" \"{0}\" > \"{1}\"", part, path("joined.ts")).c_str()), 0);
  const auto one = track_of(part), in_order = track_of(path("joined.ts")), jumping = track_of(path("joined.ts"));
  ASSERT_TRUE(one && in_order && jumping);
  std::vector<float> all;
  for (int block = 0; block < kParts * kPart * kRate / kBlock; ++block) {
    const auto some = samples_of(*in_order, block * kBlock, kBlock);
    all.insert(all.end(), some.begin(), some.end());
  }
  for (const std::int64_t first : {20'000, 48'000, 80'000}) {
    const auto expected = samples_of(*one, first, kBlock);
    EXPECT_GT(*std::ranges::max_element(expected), 0.05) << "is heard";
    for (const int at : {2, 0, 1}) {
      const std::int64_t place = at * kPart * kRate + first;
      EXPECT_LT(least_difference(expected, all, static_cast<std::size_t>(place), kRate / 100), 0.02) << place;
      const auto there = samples_of(*jumping, place - kBlock, 3 * kBlock);
      EXPECT_LT(least_difference(expected, there, kBlock, kBlock), 0.02) << place << ", after a jump";
    }
  }
}

TEST_F(Sounds, CodecsGiveAfterASeekWhatTheyGiveInOrder) {
  struct Kind {
    const char *name, *codec;
    int lag;  ///< samples that stamps may be off by
    double most = 0.01;
  };
  for (const Kind& kind :
       {Kind{"a.mp4", "-c:v mpeg4 -c:a aac -b:a 192k", 0},
        Kind{"b.mkv", "-c:v mpeg4 -c:a libopus -b:a 160k", kStampRound, 0.05 /* its decoder remembers long */},
        Kind{"c.webm", "-c:v libvpx -c:a libvorbis", kStampRound}, Kind{"d.mkv", "-c:v mpeg4 -c:a flac", kStampRound},
        Kind{"e.mkv", "-c:v mpeg4 -c:a libmp3lame -b:a 192k", kStampRound},
        Kind{"f.mp4", "-c:v mpeg4 -c:a aac -ar 44100 -ac 1", 0}}) {
    const std::string file = sounding(kind.name, kNoise, kind.codec, 8);
    const auto in_order = track_of(file), jumping = track_of(file);
    ASSERT_TRUE(in_order && jumping) << kind.name;
    std::vector<float> all;
    for (int block = 0; block < 780; ++block) {
      const auto some = samples_of(*in_order, block * 480, 480);
      all.insert(all.end(), some.begin(), some.end());
    }
    std::mt19937 random(5);
    for (int i = 0; i < 20; ++i) {
      const std::size_t first = random() % (779 * 480);
      const auto there = samples_of(*jumping, static_cast<std::int64_t>(first), 480);
      EXPECT_LT(least_difference(there, all, first, kind.lag), kind.most) << kind.name << " at " << first;
    }
  }
}

TEST_F(Sounds, SoundThatBeginsLaterAndNone) {
  const auto late = track_of(sounding("late.mkv", "-itsoffset 0.5 " + kCounting, "-c:v mjpeg -c:a pcm_s16le", 3));
  ASSERT_TRUE(late);
  EXPECT_EQ(samples_of(*late, kRate / 4, 100), std::vector<float>(200));
  EXPECT_NEAR(samples_of(*late, kRate / 2 + 1000, 1)[0], 1000.0 / 32768, 2e-3);
  EXPECT_EQ(samples_of(*late, kRate / 4, 100), std::vector<float>(200));
  EXPECT_FALSE(track_of(clip("silent.mp4", "-c:v mpeg4", 8)));
}

/// A video that is played round and round: more bytes are read than the file has, many times.
TEST_F(Sounds, ATrackIsReadForEver) {
  // 6 MB of pictures beside the sound: after eighteen turns 64 MiB and four times the file had been read.
  ffmpeg(
      fmt::format("-f lavfi -i nullsrc=s=320x240:r=24:d=2,geq='random(1)*255:128:128' {} -map 0:v -map 1:a -c:v mjpeg "
                  "-q:v 1 -c:a pcm_s16le -t 2 \"{}\"",
                  kNoise, path("big.mov")));
  const auto bytes = std::filesystem::file_size(path("big.mov"));
  const auto track = track_of(path("big.mov"));
  ASSERT_TRUE(track);
  const auto turns = static_cast<int>((64u << 20) / bytes) + 8;
  const auto first = samples_of(*track, 1000, 480);
  for (int turn = 0; turn < turns; ++turn) {
    for (int at = 0; at < 2 * kRate; at += kRate / 4) samples_of(*track, at, kRate / 4);
    ASSERT_EQ(samples_of(*track, 1000, 480), first) << "turn " << turn << " of " << turns;
  }
}

/// Hears what it is given by a clock of its own, which runs `rate` times as fast as the test's.
struct Listener {
  std::mutex mutex;
  std::condition_variable changed;
  double now = 0, rate = 1;
  double began = 0;          ///< when what is in the device began to be heard
  std::int64_t written = 0;  ///< since then
  int drops = 0;
  std::vector<int> heard;  ///< left, as kCounting numbers its samples
  bool ends = false;
  bool takes_all = false;  ///< at once, and says that nothing waits
  static constexpr double kHolds = 0.1 * kRate;

  double left() const { return std::max(0.0, static_cast<double>(written) - (now - began) * rate * kRate); }
  double clock() {
    const std::lock_guard lock(mutex);
    return now;
  }
  /// Time goes on, until the device is full again.
  void advance(double seconds) {
    std::unique_lock lock(mutex);
    now += seconds;
    changed.notify_all();
    changed.wait(lock, [&] { return left() + 480 > kHolds || ends; });
  }
};

class ListeningDevice : public SoundDevice {
 public:
  explicit ListeningDevice(Listener& listener) : to_(listener) {}
  Result<void> write(std::span<const float> samples) override {
    std::unique_lock lock(to_.mutex);
    const auto frames = static_cast<std::int64_t>(samples.size()) / SoundTrack::kChannels;
    to_.changed.notify_all();
    to_.changed.wait(lock, [&] {
      return to_.ends || to_.takes_all || to_.left() + static_cast<double>(frames) <= Listener::kHolds;
    });
    if (to_.left() <= 0) {
      to_.began = to_.now;
      to_.written = 0;
    }
    to_.written += frames;
    for (std::size_t i = 0; i < samples.size(); i += SoundTrack::kChannels)
      to_.heard.push_back(static_cast<int>(std::lround(samples[i] * 32768)));
    to_.changed.notify_all();
    return {};
  }
  double delay() override {
    const std::lock_guard lock(to_.mutex);
    return to_.takes_all ? 0 : to_.left();
  }
  void drop() override {
    const std::lock_guard lock(to_.mutex);
    to_.began = to_.now;
    to_.written = 0;
    ++to_.drops;
  }

 private:
  Listener& to_;
};

class Following : public Sounds {
 protected:
  void begin(const std::string& file, double rate) {
    auto opened = Footage::open({.inputs = {file}, .frames = {}, .read = {}}, none_);
    ASSERT_TRUE(opened) << opened.error().text();
    footage_ = *opened;
    listener_.rate = rate;
    sound_ = std::make_unique<Sound>(
        SoundOptions{.open_device = [this]() -> Result<std::unique_ptr<SoundDevice>> {
          return std::unique_ptr<SoundDevice>(std::make_unique<ListeningDevice>(listener_));
        }},
        [this] { return listener_.clock(); }, nullptr);
    transport_ = Transport(footage_->frames(), footage_->fps().value_or(0));
  }
  void TearDown() override {
    {
      const std::lock_guard lock(listener_.mutex);
      listener_.ends = true;
      listener_.changed.notify_all();
    }
    sound_.reset();
    Clips::TearDown();
  }
  void turn(double seconds) {
    listener_.advance(seconds);
    follower_.follow(transport_, *footage_, *sound_, listener_.now);
  }
  /// Seconds by which the picture is behind what is heard.
  double off() {
    const auto heard = sound_->heard(listener_.now);
    EXPECT_TRUE(heard);
    const double picture = (transport_.position() + transport_.fraction(listener_.now)) / transport_.fps();
    return heard.value_or(0) - picture;
  }

  Diagnostics none_;
  Listener listener_;
  std::shared_ptr<const Footage> footage_;
  std::unique_ptr<Sound> sound_;
  SoundFollower follower_;
  Transport transport_{1};
};

TEST_F(Following, PicturesStayWithASoundCardThatIsFasterOrSlower) {
  const std::string file = sounding("minute.mkv", kCounting, "-c:v mjpeg -c:a pcm_s16le", 62);
  begin(file, 1.003);  // 180 ms in a minute, if nobody followed
  transport_.play(0);
  follower_.follow(transport_, *footage_, *sound_, 0);
  double most = 0;
  for (int i = 0; i < 60 * 60; ++i) {
    turn(1.0 / 60);
    if (i > 30) most = std::max(most, std::abs(off()));
  }
  EXPECT_LT(most, 0.5 / 24) << "half a frame";
  EXPECT_EQ(listener_.drops, 0) << "it never began anew";
  EXPECT_NEAR(transport_.position() + transport_.fraction(listener_.now), 60 * 24 * 1.003, 1);
  EXPECT_EQ(transport_.dropped(), 0u);
}

/// ALSA's null and file: what servers and containers have.
TEST_F(Following, ADeviceWithoutAClockGoesByThatOfThePictures) {
  begin(sounding("twenty.mkv", kCounting, "-c:v mjpeg -c:a pcm_s16le", 20), 1);
  listener_.takes_all = true;
  transport_.play(0);
  follower_.follow(transport_, *footage_, *sound_, 0);
  double most = 0;
  for (int i = 0; i < 60 * 15; ++i) {
    turn(1.0 / 60);
    if (i > 30 && sound_->heard(listener_.now)) most = std::max(most, std::abs(off()));
  }
  EXPECT_LT(most, 0.5 / 24) << "half a frame";
  EXPECT_EQ(listener_.drops, 0) << "it never began anew";
  EXPECT_NEAR(transport_.position() + transport_.fraction(listener_.now), 15 * 24, 1);
}

TEST_F(Following, ASeekMovesTheSoundAndOtherSpeedsAreSilent) {
  begin(sounding("ten.mkv", kCounting, "-c:v mjpeg -c:a pcm_s16le", 10), 1);
  transport_.play(0);
  follower_.follow(transport_, *footage_, *sound_, 0);
  turn(0.1);
  EXPECT_FALSE(sound_->playing().empty());
  transport_.go_to(120, listener_.now);
  turn(0.05);
  turn(0.05);
  EXPECT_NEAR(off(), 0, 0.02);
  EXPECT_NEAR(*sound_->heard(listener_.now), 5.1, 0.08);
  for (const double speed : {2.0, -1.0, 0.5}) {
    transport_.set_speed(speed, listener_.now);
    follower_.follow(transport_, *footage_, *sound_, listener_.now);
    EXPECT_TRUE(sound_->playing().empty()) << speed;
    EXPECT_FALSE(sound_->heard(listener_.now));
  }
  transport_.set_speed(1, listener_.now);
  follower_.follow(transport_, *footage_, *sound_, listener_.now);
  EXPECT_FALSE(sound_->playing().empty());
  transport_.pause(listener_.now);
  follower_.follow(transport_, *footage_, *sound_, listener_.now);
  EXPECT_TRUE(sound_->playing().empty());
}

/// Every sample of the loop follows the one before, and none is missing where it begins anew.
TEST_F(Following, ALoopIsHeardWithoutAGap) {
  begin(sounding("ten.mov", kCounting, "-c:v mjpeg -c:a pcm_s16le", 10), 1);
  transport_.set_range(24, 59, 0);  // from 1 s on, 1.5 s
  transport_.play(0);
  follower_.follow(transport_, *footage_, *sound_, 0);
  double most = 0;
  for (int i = 0; i < 60 * 7; ++i) {
    turn(1.0 / 60);
    // Right at the border picture and sound may lie on either side of it.
    if (i > 30) most = std::max(most, std::abs(std::remainder(off(), 1.5)));
  }
  EXPECT_LT(most, 0.5 / 24);
  EXPECT_EQ(listener_.drops, 0) << "it never began anew";
  const std::lock_guard lock(listener_.mutex);
  const auto& heard = listener_.heard;
  int around = 0;
  for (std::size_t i = 480 + 1; i < heard.size(); ++i) {
    if (heard[i] == heard[i - 1] + 1 || (heard[i] == 0 && heard[i - 1] == 29'999)) continue;
    ASSERT_EQ(heard[i - 1], (60 * 2000 - 1) % 30'000) << i;
    ASSERT_EQ(heard[i], 24 * 2000 % 30'000) << i;
    ++around;
  }
  EXPECT_EQ(around, 4);
}

TEST_F(Following, ALoopThatChangesIsFollowed) {
  begin(sounding("ten.mov", kCounting, "-c:v mjpeg -c:a pcm_s16le", 10), 1);
  transport_.set_range(24, 59, 0);
  transport_.play(0);
  follower_.follow(transport_, *footage_, *sound_, 0);
  for (int i = 0; i < 60; ++i) turn(1.0 / 60);
  transport_.clear_range(listener_.now);
  for (int i = 0; i < 90; ++i) turn(1.0 / 60);
  EXPECT_NEAR(off(), 0, 0.5 / 24);
  EXPECT_GT(transport_.position(), 59);
  transport_.set_loop(LoopMode::ping_pong, listener_.now);
  for (int i = 0; i < 30; ++i) turn(1.0 / 60);
  EXPECT_NEAR(off(), 0, 0.5 / 24);
}

TEST_F(Following, FramesAtAnotherRateThanTheFileAreSilent) {
  const std::string file = sounding("ten.mkv", kCounting, "-c:v mjpeg -c:a pcm_s16le", 4);
  begin(file, 1);
  EXPECT_NEAR(sound_moment(*footage_, 48, 0.5, 24).value_or(0), 48.5 / 24, 2e-3);
  EXPECT_FALSE(sound_moment(*footage_, 48, 0.5, 25));
  const auto second = Footage::open({.inputs = {file}, .frames = "1-90x2", .read = {}}, none_);
  ASSERT_TRUE(second);
  EXPECT_FALSE(sound_moment(**second, 3, 0, 24));
  const auto part = Footage::open({.inputs = {file}, .frames = "49-90", .read = {}}, none_);
  ASSERT_TRUE(part);
  EXPECT_NEAR(sound_moment(**part, 0, 0, 24).value_or(0), 2, 2e-3);
}

#ifdef AFTERGLOW_HAS_SOUND
/// ALSA's, and how many samples a channel it was given.
class CountedDevice : public SoundDevice {
 public:
  CountedDevice(std::unique_ptr<SoundDevice> device, std::atomic<std::size_t>& written)
      : device_(std::move(device)), written_(written) {}
  Result<void> write(std::span<const float> samples) override {
    auto done = device_->write(samples);
    written_ += samples.size() / SoundTrack::kChannels;
    return done;
  }
  double delay() override { return device_->delay(); }
  void drop() override { device_->drop(); }

 private:
  std::unique_ptr<SoundDevice> device_;
  std::atomic<std::size_t>& written_;
};

/// ALSA itself, into a file. The clock stands: exactly what is kept ahead is written.
TEST_F(Sounds, AlsaGetsTheSamplesOfEachPlace) {
  const std::string raw = path("heard.raw"), config = path("asound.conf");
  std::ofstream(config) << "pcm.!default { type file slave.pcm { type null } file \"" << raw << "\" format raw }\n";
  setenv("ALSA_CONFIG_PATH", config.c_str(), 1);
  const auto movie = open(sounding("a.mov", kCounting, "-c:v mjpeg -c:a pcm_s16le", 6));
  ASSERT_TRUE(movie);
  std::string said;
  {
    std::atomic<std::size_t> written = 0;
    const auto counted = [&]() -> Result<std::unique_ptr<SoundDevice>> {
      AFTERGLOW_TRY(auto device, open_sound_device());
      return std::unique_ptr<SoundDevice>(std::make_unique<CountedDevice>(std::move(device), written));
    };
    Sound sound(
        {.open_device = counted}, [] { return 10.0; }, [&](const std::string& why) { said = why; });
    std::size_t wanted = 0;
    for (const double from : {2.0, 5.0}) {
      sound.play("a.mov", from, [&] { return SoundTrack::open(*movie); });
      wanted += 9600;
      while ((written < wanted || !sound.heard(10.0)) && sound.failure().empty()) std::this_thread::yield();
      EXPECT_DOUBLE_EQ(sound.heard(10.0).value_or(0), from) << "the clock stands";
    }
  }
  ASSERT_EQ(said, "");
  const std::string bytes = read_file(raw).value();
  ASSERT_EQ(bytes.size() % 8, 0u);
  std::vector<int> numbers;
  for (std::size_t at = 0; at < bytes.size(); at += 8) {
    float left = 0;
    std::memcpy(&left, bytes.data() + at, 4);
    numbers.push_back(static_cast<int>(std::lround(left * 32768)));
  }
  // The first block comes in softly.
  ASSERT_EQ(numbers.size(), 2u * 9600);
  for (int i = 480; i < 9600; ++i) {
    ASSERT_EQ(numbers[static_cast<std::size_t>(i)], (2 * kRate + i) % 30'000);
    ASSERT_EQ(numbers[static_cast<std::size_t>(9600 + i)], (5 * kRate + i) % 30'000);
  }
}

TEST_F(Sounds, NoSoundDeviceIsToldOnce) {
  const std::string config = path("asound.conf");
  std::ofstream(config) << "pcm.!default { type hw card 31 }\n";
  setenv("ALSA_CONFIG_PATH", config.c_str(), 1);
  const auto movie = open(sounding("a.mov", kCounting, "-c:v mjpeg -c:a pcm_s16le", 2));
  std::vector<std::string> said;
  Sound sound(
      {}, [] { return 10.0; }, [&](const std::string& why) { said.push_back(why); });
  for (int i = 0; i < 3; ++i) {
    sound.play("a.mov", 0, [&] { return SoundTrack::open(*movie); });
    while (sound.failure().empty()) std::this_thread::yield();
  }
  EXPECT_THAT(said, testing::ElementsAre(testing::StartsWith("there is no sound: ALSA's device 'default': ")));
  EXPECT_FALSE(sound.heard(10.0));
}
#endif

}  // namespace
}  // namespace afterglow
