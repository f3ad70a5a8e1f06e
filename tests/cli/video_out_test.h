// SPDX-License-Identifier: MIT
// What the tests of written videos share: frames that carry their number, and the programs ffmpeg and ffprobe to look
// at what came out.
#pragma once

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli_test.h"

namespace afterglow::test {

inline constexpr int kWidth = 96, kHeight = 64, kBits = 8, kBarRows = 16;
inline constexpr std::size_t kFrameBytes = std::size_t{kWidth} * kHeight * 3;

class VideoOut : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    if (std::system("command -v ffmpeg >/dev/null && command -v ffprobe >/dev/null") != 0)
      GTEST_SKIP() << "the program ffmpeg is not installed";
    write("look.lua",
          "local fx = require \"afterglow\"\nreturn fx.stack { name = \"nothing\", fx.color_adjustments {} }\n");
  }

  /// 8-bit sRGB: bars that say the number, above a smooth picture that moves.
  static std::string codes_of(int number, int width = kWidth, int height = kHeight) {
    std::string codes;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        if (y < kBarRows) {
          codes.append(3, static_cast<char>(number >> (x * kBits / width) & 1 ? 220 : 30));
          continue;
        }
        for (const double phase : {0.0, 1.0, 2.1})
          codes +=
              static_cast<char>(std::lround(128 + 90 * std::sin((x + number) / 30.0 + phase) * std::cos(y / 25.0)));
      }
    return codes;
  }
  static int number_of(const std::string& codes) {
    int number = 0;
    for (int bit = 0; bit < kBits; ++bit) {
      const int x = bit * kWidth / kBits + kWidth / kBits / 2;
      const auto value =
          static_cast<std::uint8_t>(codes[(std::size_t{kBarRows} / 2 * kWidth + static_cast<std::size_t>(x)) * 3]);
      number |= (value > 128 ? 1 : 0) << bit;
    }
    return number;
  }
  void make_frames(int count, int width = kWidth, int height = kHeight) const {
    for (int frame = 1; frame <= count; ++frame) {
      std::ostringstream head;
      head << "P6\n" << width << " " << height << "\n255\n";
      write("in/" + std::to_string(1000 + frame) + ".ppm", head.str() + codes_of(frame, width, height));
    }
  }
  Outcome make_video(const std::string& name, std::vector<std::string> more = {},
                     const RunOptions& options = {}) const {
    std::vector<std::string> arguments{"run", "look.lua", "in/####.ppm", "-o", name, "--output-space", "srgb"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments, options);
  }
  Outcome shell(const std::string& command) const {
    RunOptions options;
    options.program = "/bin/sh";
    options.environment["AFTERGLOW"] = AFTERGLOW_PROGRAM;
    return run({"-c", command}, options);
  }
  /// Frames as 8-bit RGB.
  std::vector<std::string> frames_of(const std::string& name) const {
    const Outcome outcome = shell("ffmpeg -v error -i " + name +
                                  " -vsync passthrough -sws_flags accurate_rnd+full_chroma_int+bicubic -pix_fmt rgb24 "
                                  "-f rawvideo -y decoded.raw");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    const std::string raw = read("decoded.raw");
    EXPECT_EQ(raw.size() % kFrameBytes, 0u);
    std::vector<std::string> frames;
    for (std::size_t at = 0; at < raw.size(); at += kFrameBytes) frames.push_back(raw.substr(at, kFrameBytes));
    return frames;
  }
  nlohmann::json probe(const std::string& name, const std::string& what) const {
    const Outcome outcome = shell("ffprobe -v error -of json " + what + " " + name);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out);
  }
  nlohmann::json stream_of(const std::string& name) const {
    return probe(name, "-select_streams v -show_streams").at("streams").at(0);
  }
  /// Root of the mean of squares, in codes.
  static double difference(const std::string& a, const std::string& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      const double d = static_cast<std::uint8_t>(a[i]) - static_cast<std::uint8_t>(b[i]);
      sum += d * d;
    }
    return std::sqrt(sum / static_cast<double>(a.size()));
  }
  bool has_leftovers() const {
    for (const auto& name : files())
      if (name.find(".tmp") != std::string::npos) return true;
    return false;
  }
};

}  // namespace afterglow::test
