// SPDX-License-Identifier: MIT
// An evening with the player: frames that are gone to by their number, saved looks, windows of other sizes, in any
// order. Each time the window must show that frame with that look. AFTERGLOW_LONG=1 takes 2,000 turns and at least half
// an hour in place of a few turns.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <random>

#include "play_window_test.h"

namespace afterglow {
namespace {

constexpr int kFrames = 40;

/// Of another process.
struct Holds {
  std::size_t bytes = 0, handles = 0, threads = 0;
  explicit Holds(pid_t pid) {
    const fs::path folder = fs::path("/proc") / std::to_string(pid);
    std::ifstream statm(folder / "statm");
    std::size_t pages = 0;
    if (statm >> pages >> pages) bytes = pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder / "fd")) ++handles;
    for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder / "task")) ++threads;
  }
};

int srgb_code(double light) {
  const double code = light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
  return static_cast<int>(std::lround(255 * code));
}

class PlaySoak : public PlayWindow {
 protected:
  /// Colours that tell frames apart by far more than a code.
  static Light light_of(int frame) {
    return {0.05f + 0.1f * static_cast<float>(frame % 8), 0.05f + 0.15f * static_cast<float>(frame / 8), 0.4f};
  }

  void write_frames() {
    for (int frame = 1; frame <= kFrames; ++frame)
      ASSERT_NO_FATAL_FAILURE(write_picture_file(fmt::format("soak.{:04}.exr", frame), light_of(frame)));
  }

  /// A look that keeps `keeps` of each channel; saved at once, as editors do.
  void save_look() {
    ASSERT_TRUE(write_file_atomically(folder_ / "look.lua",
                                      fmt::format("local fx = require \"afterglow\"\nreturn fx.stack {{\n"
                                                  "  fx.color_adjustments {{ color_filter = {{ {}, {}, {} }} }},\n}}\n",
                                                  keeps_[0], keeps_[1], keeps_[2])));
  }

  Color wanted() const {
    const auto light = light_of(frame_);
    Color out;
    for (std::size_t i = 0; i < 3; ++i) out[i] = srgb_code(double{light[i]} * keeps_[i]);
    return out;
  }

  void go_to_a_frame() {
    frame_ = std::uniform_int_distribution(1, kFrames)(random_);
    ASSERT_TRUE(user(fmt::format("key ctrl+g type {}", frame_)));
    ASSERT_TRUE(user("key Return"));
    ++seeks_;
  }
  void save_another_look() {
    for (double& keep : keeps_) keep = std::uniform_int_distribution(1, 4)(random_) / 4.0;
    save_look();
    ++saves_;
  }
  void resize() {
    const int width = std::uniform_int_distribution(700, 1200)(random_);
    const int height = std::uniform_int_distribution(500, 750)(random_);
    ASSERT_TRUE(user(fmt::format("search --class afterglow windowsize {} {}", width, height)));
    ++sizes_;
  }

  void take_turn() {
    const int kind = std::uniform_int_distribution(0, 9)(random_);
    if (kind < 6) {
      go_to_a_frame();
    } else if (kind < 9) {
      save_another_look();
    } else {
      resize();
    }
    if (HasFatalFailure()) return;
    ASSERT_TRUE(until_color(0.25, 0.3, wanted()))
        << "frame " << frame_ << " with the look { " << keeps_[0] << ", " << keeps_[1] << ", " << keeps_[2]
        << " } does not show after " << seeks_ << " seeks, " << saves_ << " saves and " << sizes_ << " sizes";
  }

  std::mt19937 random_{7};
  std::array<double, 3> keeps_{1, 1, 1};
  int frame_ = 1, seeks_ = 0, saves_ = 0, sizes_ = 0;
};

TEST_F(PlaySoak, EachTurnShowsItsFrameWithItsLookAndNothingGrows) {
  const bool is_long = std::getenv("AFTERGLOW_LONG") != nullptr;
  const int warm = is_long ? 200 : 10, turns = is_long ? 2000 : 20;
  const auto least = std::chrono::minutes(is_long ? 30 : 0);
  const auto began = std::chrono::steady_clock::now();
  if (is_long) setenv("AFTERGLOW_VALIDATE", "0", 1);  // the layer's own memory grows with all that it has seen
  write_frames();
  save_look();
  play({"look.lua", "soak.####.exr", "--paused"});
  ASSERT_TRUE(program_->wait_for("shown soak.0001.exr"));
  ASSERT_TRUE(user("mousemove 300 250"));
  for (int turn = 0; turn < warm; ++turn) ASSERT_NO_FATAL_FAILURE(take_turn());
  const Holds before(program_->pid());
  int turn = 0;
  for (; turn < turns || std::chrono::steady_clock::now() - began < least; ++turn) ASSERT_NO_FATAL_FAILURE(take_turn());
  const Holds after(program_->pid());
  const double minutes =
      std::chrono::duration<double, std::ratio<60>>(std::chrono::steady_clock::now() - began).count();
  fmt::print("{} turns in {:.0f} minutes: {} seeks, {} saves, {} sizes; {:.0f} MiB, then {:.0f} MiB\n", warm + turn,
             minutes, seeks_, saves_, sizes_, static_cast<double>(before.bytes) / (1 << 20),
             static_cast<double>(after.bytes) / (1 << 20));
  EXPECT_LE(after.bytes, before.bytes + (24u << 20));
  EXPECT_LE(after.handles, before.handles + 4);
  // The watch for NaN and the pictures of looks have devices of their own, which may come late: lavapipe's threads.
  constexpr std::size_t kOfDevices = 2 * 6;
  EXPECT_LE(after.threads, before.threads + 2 + kOfDevices);
  ASSERT_TRUE(user("key q"));
  expect_clean_end();
}

}  // namespace
}  // namespace afterglow
