// SPDX-License-Identifier: MIT
// What a user hears: ALSA's own library, with a file in the place of a sound card.
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "play_window_test.h"

namespace afterglow {
namespace {

TEST_F(PlayWindow, AVideoIsHeardWhileItPlaysAndUMakesItSilent) {
  const std::string raw = (folder_ / "heard.raw").string(), clip = (folder_ / "clip.mov").string();
  std::ofstream(folder_ / "asound.conf") << "pcm.!default { type file slave.pcm { type null } file \"" << raw
                                         << "\" format raw }\n";
  setenv("ALSA_CONFIG_PATH", (folder_ / "asound.conf").c_str(), 1);
  // Left counts samples.
  ASSERT_EQ(std::system(("ffmpeg -v error -f lavfi -i color=c=gray:s=64x40:r=24 -f lavfi -i "
                         "'aevalsrc=mod(n\\,30000)/32768|0.5:s=48000' -t 20 -c:v mjpeg -c:a pcm_s16le " +
                         clip)
                            .c_str()),
            0);
  write_preset("{ 1, 0, 0 }");
  play({"look.lua", "clip.mov", "--paused"});
  ASSERT_TRUE(program_->wait_for("position 0"));
  EXPECT_EQ(text_of("heard.raw"), "") << "nothing is heard while it stands";
  ASSERT_TRUE(user("mousemove 400 300 key space"));
  ASSERT_TRUE(until([&] { return text_of("heard.raw").size() > std::size_t{9600} * 8; }));
  const std::string bytes = text_of("heard.raw");
  const auto sample = [&](std::size_t frame, std::size_t channel) {
    float value = 0;
    std::memcpy(&value, bytes.data() + frame * 8 + channel * 4, 4);
    return value;
  };
  const long first = std::lround(sample(480, 0) * 32768);  // the block before comes in softly
  EXPECT_GE(first, 480);
  for (std::size_t i = 480; i < 4800; ++i) {
    ASSERT_EQ(std::lround(sample(i, 0) * 32768), (first + static_cast<long>(i) - 480) % 30'000) << i;
    ASSERT_NEAR(sample(i, 1), 0.5, 1e-3);
  }

  // The right channel is 0.5 times the volume; changes come in softly.
  const auto heard_at = [&](float volume) {
    return until([&] {
      const std::string now = text_of("heard.raw");
      constexpr std::size_t kTail = 1200;
      if (now.size() < kTail * 8) return false;
      for (std::size_t i = 0; i < kTail; ++i) {
        float value = 0;
        std::memcpy(&value, now.data() + (now.size() / 8 - kTail + i) * 8 + 4, 4);
        if (std::abs(value - 0.5f * volume) > 1e-3f) return false;
      }
      return true;
    });
  };
  EXPECT_TRUE(heard_at(1));
  ASSERT_TRUE(user("key bracketleft key bracketleft"));
  EXPECT_TRUE(heard_at(0.8f));
  ASSERT_TRUE(user("key bracketright"));
  EXPECT_TRUE(heard_at(0.9f));

  ASSERT_TRUE(user("key u"));
  EXPECT_TRUE(until([&] {
    const std::string now = text_of("heard.raw");
    constexpr std::size_t kTail = 2400 * 8;
    return now.size() > kTail && now.substr(now.size() - kTail) == std::string(kTail, '\0');
  }));
  ASSERT_TRUE(user("key q"));
  expect_clean_end();
}

}  // namespace
}  // namespace afterglow
