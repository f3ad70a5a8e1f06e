// SPDX-License-Identifier: MIT
// A look that follows its file, in C++: edits of the preset show from the next frame on.
//
//   memory_cpp PRESET [FRAMES]
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "afterglow.hpp"

int main(int argc, char** argv) try {
  if (argc < 2) return std::fprintf(stderr, "usage: memory_cpp PRESET [FRAMES]\n"), 2;
  const int frames = argc > 2 ? std::atoi(argv[2]) : 3;
  constexpr int kWidth = 320, kHeight = 180;

  const afterglow::Device device;
  afterglow::StackOptions options;
  options.follow = true;
  options.message = [](afterglow_severity, std::string_view text) {
    std::fprintf(stderr, "%.*s\n", static_cast<int>(text.size()), text.data());
  };
  afterglow::Stack stack(device, argv[1], options);

  std::vector<float> picture(kWidth * kHeight * 4), result(picture.size());
  afterglow_run_info info = afterglow_run_info_default();
  info.source = afterglow::image(picture.data(), kWidth, kHeight);
  info.result = afterglow::image(result.data(), kWidth, kHeight);
  for (int number = 1; number <= frames; ++number) {
    // A spark that moves to the right.
    for (std::size_t i = 0; i < picture.size(); ++i) picture[i] = i % 4 == 3 ? 1.0f : 0.02f;
    picture[(static_cast<std::size_t>(kHeight) / 2 * kWidth + static_cast<std::size_t>(number * 8 % kWidth)) * 4] = 500;

    try {
      if (stack.update()) std::printf("frame %d: the preset has changed\n", number);
    } catch (const afterglow::Error& error) {
      std::printf("frame %d: %s:%d: %s\n", number, error.file.c_str(), error.line, error.message.c_str());
    }

    afterglow_frame frame = afterglow_frame_default();
    frame.number = number;
    frame.time = number / frame.fps;  // as `afterglow run` counts
    info.frame = &frame;
    stack.run(info);
  }
  float sum = 0;
  for (const float sample : result) sum += sample;
  std::printf("%d frames; the mean of the last one is %g\n", frames, static_cast<double>(sum) / result.size());
  return 0;
} catch (const afterglow::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return error.kind;
}
