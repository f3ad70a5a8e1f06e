// SPDX-License-Identifier: MIT
// Frames that carry their number as bars are gone to in every way there is, in any order: the picture, the label in the
// bar and the window's title always name the same frame. AFTERGLOW_LONG=1 takes a thousand ways in place of a few.
#include <fmt/format.h>

#include <cstdlib>
#include <map>
#include <random>

#include "play_window_test.h"

namespace afterglow {
namespace {

constexpr int kFrames = 120, kBits = 7;

/// Eight bars of eight columns: the bits of a number, and a last one that makes the count of light ones even.
bool bar_is_light(int number, int bar) {
  const int bits = __builtin_popcount(static_cast<unsigned>(number));
  return bar < kBits ? (number >> bar & 1) != 0 : bits % 2 != 0;
}

class PlaySeeks : public PlayWindow {
 protected:
  /// What the bars on the screen say; none while it is no number.
  static std::optional<int> number_on(const Screen& screen) {
    constexpr int kWidth = 904, kY = 340;  // the picture has the window's width beside the panel
    if (screen.rgb.empty()) return std::nullopt;
    int number = 0, light = 0;
    for (int bar = 0; bar <= kBits; ++bar) {
      const bool on = screen.at(kWidth * (2 * bar + 1) / 16, kY)[1] > 125;
      light += on ? 1 : 0;
      if (on && bar < kBits) number |= 1 << bar;
    }
    return light % 2 == 0 ? std::optional(number) : std::nullopt;
  }
  /// The bar's "1012  12/120", as it looks.
  static std::vector<std::uint8_t> label_on(const Screen& screen) {
    std::vector<std::uint8_t> out;
    for (int y = 738; y < 762; ++y) out.insert(out.end(), screen.at(716, y), screen.at(900, y));
    return out;
  }

  void open(const std::vector<std::string>& arguments) {
    write_preset("{ 1, 1, 1 }");
    std::vector<std::string> all{"look.lua", "--paused", "--cache", "1M", "--geometry", "1280x800+0+0"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    play(all);
    ASSERT_TRUE(program_->wait_for("shown "));
    ASSERT_TRUE(user("mousemove 1150 790"));
  }

  /// The picture of a number, with the label that it always has and no other picture has.
  void expect_frame(int number, const std::string& way) {
    Screen screen;
    const auto known = labels_.find(number);
    ASSERT_TRUE(until([&] {
      screen = shot();
      return number_on(screen) == number && (known == labels_.end() || label_on(screen) == known->second);
    })) << "picture "
        << number << " with its label, by " << way << "; seen is " << number_on(screen).value_or(-1);
    if (known == labels_.end()) {
      const auto label = label_on(screen);
      for (const auto& [other, its] : labels_) ASSERT_NE(its, label) << other << " and " << number;
      labels_[number] = label;
    }
    EXPECT_TRUE(until([&] { return window_title(xvfb_.display()).starts_with(title_(number)); }))
        << window_title(xvfb_.display()) << " for picture " << number;
    at_ = number;
  }

  void go_by_number(int number) {
    ASSERT_TRUE(user(fmt::format("key ctrl+g type {}", first_ + number)));
    ASSERT_TRUE(user("key Return"));
    expect_frame(number, "its number");
  }
  void go_by_timeline(int number) {
    const double left = 12, width = 880;
    ASSERT_TRUE(user(fmt::format("mousemove {:.0f} 720 click 1", left + (number + 0.5) * width / kFrames)));
    ASSERT_TRUE(user("mousemove 1150 790"));
    expect_frame(number, "the timeline");
  }
  void step_by_key() {
    struct Key {
      const char* name;
      int to;
    };
    const int last = kFrames - 1;
    const Key keys[] = {
        {"Right", at_ < last ? at_ + 1 : 0}, {"Left", at_ > 0 ? at_ - 1 : last}, {"Home", 0}, {"End", last}};
    const Key& key = keys[std::uniform_int_distribution(0, 3)(random_)];
    ASSERT_TRUE(user(std::string("key ") + key.name));
    expect_frame(key.to, key.name);
  }
  /// Wherever it stops: what is shown has its own label.
  void play_for_a_while() {
    ASSERT_TRUE(user("key space"));
    ASSERT_TRUE(until([&] { return number_on(shot()).value_or(at_) != at_; }));
    ASSERT_TRUE(user("key k"));
    Screen screen = shot();
    ASSERT_TRUE(until([&] {
      const Screen before = std::exchange(screen, shot());
      return before.rgb == screen.rgb && number_on(screen);
    })) << "it stands";
    expect_frame(*number_on(screen), "playing");
  }

  void go_about(int ways) {
    std::map<int, int> taken;
    for (int way = 0; way < ways; ++way) {
      const int kind = std::uniform_int_distribution(0, 9)(random_);
      const int number = std::uniform_int_distribution(0, kFrames - 1)(random_);
      if (kind < 5) {
        go_by_number(number);
      } else if (kind < 7) {
        go_by_timeline(number);
      } else if (kind < 9) {
        step_by_key();
      } else {
        play_for_a_while();
      }
      if (HasFatalFailure()) return;
      ++taken[kind < 5 ? 0 : kind < 7 ? 1 : kind < 9 ? 2 : 3];
    }
    fmt::print("{} by number, {} on the timeline, {} by keys, {} by playing; {} of {} frames seen\n", taken[0],
               taken[1], taken[2], taken[3], labels_.size(), kFrames);
    ASSERT_TRUE(user("key q"));
    expect_clean_end();
  }
  static int ways(int few) { return std::getenv("AFTERGLOW_LONG") != nullptr ? 1000 : few; }

  std::mt19937 random_{16};
  std::map<int, std::vector<std::uint8_t>> labels_;
  std::function<std::string(int)> title_;
  int first_ = 0;  ///< number of the first frame
  int at_ = 0;
};

TEST_F(PlaySeeks, PicturesOfASequenceHaveTheirLabels) {
  for (int number = 0; number < kFrames; ++number)
    ASSERT_NO_FATAL_FAILURE(write_picture_file(fmt::format("seek.{}.exr", 1001 + number), [&](int x, int) {
      const float level = bar_is_light(number, x / 8) ? 0.5f : 0.05f;
      return Light{level, level, level};
    }));
  first_ = 1001;
  title_ = [](int number) { return fmt::format("seek.{}.exr", 1001 + number); };
  ASSERT_NO_FATAL_FAILURE(open({"seek.####.exr"}));
  go_about(ways(30));
}

/// Each frame but one of a hundred leans on others, before it and behind it.
TEST_F(PlaySeeks, FramesOfAVideoHaveTheirLabels) {
  const std::string bit = "mod(floor(N/pow(2\\,floor(X/8)))\\,2)";
  std::string even = "0";
  for (int i = 0; i < kBits; ++i) even += fmt::format("+mod(floor(N/{})\\,2)", 1 << i);
  ASSERT_EQ(
      std::system(fmt::format("ffmpeg -v error -f lavfi -i \"color=c=black:s=64x40:r=24,format=yuv420p,"
                              "geq=lum='40+190*if(lt(X\\,56)\\,{}\\,mod({}\\,2))':cb=128:cr=128,trim=end_frame={}\" "
                              "-c:v libx264 -bf 3 -g 100 -qp 12 {}",
                              bit, even, kFrames, (folder_ / "seek.mp4").string())
                      .c_str()),
      0);
  first_ = 1;
  title_ = [](int) { return std::string("seek.mp4"); };
  ASSERT_NO_FATAL_FAILURE(open({"seek.mp4"}));
  go_about(ways(30));
}

}  // namespace
}  // namespace afterglow
