// SPDX-License-Identifier: MIT
// What a call over the C interface costs beside the engine itself: both make the same 1920×1080 picture in turns,
// each in the memory of its source.
//
//   embed_cost PRESET [ROUNDS]
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "afterglow.h"
#include "session/session.h"

namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

void need(afterglow_error* error) {
  if (!error) return;
  std::fprintf(stderr, "%s\n", afterglow_error_get_text(error).data);
  std::exit(1);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return std::fprintf(stderr, "usage: embed_cost PRESET [ROUNDS]\n"), 2;
  const int rounds = argc > 2 ? std::atoi(argv[2]) : 30;
  constexpr int kWidth = 1920, kHeight = 1080;
  std::vector<float> source(static_cast<std::size_t>(kWidth) * kHeight * 4), pixels(source.size());
  for (std::size_t i = 0; i < source.size(); ++i) source[i] = i % 4 == 3 ? 1.0f : static_cast<float>(i * 37 % 101) / 32;

  afterglow::Diagnostics none;
  const auto session = afterglow::Session::open(argv[1], {}, none);
  if (!session) return std::fprintf(stderr, "%s\n", session.error().text().c_str()), 1;
  afterglow::Picture picture;
  picture.color = afterglow::Image(kWidth, kHeight, 4);

  afterglow_device* device = nullptr;
  afterglow_stack* stack = nullptr;
  need(afterglow_device_open(nullptr, &device));
  afterglow_stack_options options = afterglow_stack_options_default();
  options.preset_file = afterglow_str(argv[1]);
  need(afterglow_stack_create(device, &options, &stack));
  afterglow_run_info info = afterglow_run_info_default();
  info.source = {pixels.data(), kWidth, kHeight, 4, AFTERGLOW_FLOAT, 0, 0};
  info.result = {pixels.data(), kWidth, kHeight, 4, AFTERGLOW_FLOAT, 0, 0};

  const auto timed = [&](std::vector<float>& memory, const auto& call) {
    std::copy(source.begin(), source.end(), memory.begin());
    const auto start = Clock::now();
    call();
    return milliseconds_since(start);
  };
  const auto by_engine = [&] {
    return timed(picture.color.pixels, [&] {
      const auto done = (*session)->process(picture);
      if (!done) std::fprintf(stderr, "%s\n", done.error().text().c_str()), std::exit(1);
    });
  };
  const auto by_interface = [&] { return timed(pixels, [&] { need(afterglow_stack_run(stack, &info)); }); };

  std::vector<double> engine, interface, ratio;
  for (int round = -2; round < rounds; ++round) {  // the first ones make shaders and memory
    const bool engine_first = round % 2 == 0;      // whoever comes second finds other caches
    const double before = engine_first ? by_engine() : by_interface();
    const double after = engine_first ? by_interface() : by_engine();
    if (round < 0) continue;
    engine.push_back(engine_first ? before : after);
    interface.push_back(engine_first ? after : before);
    ratio.push_back(interface.back() / engine.back());
  }
  const bool same = pixels == picture.color.pixels;
  std::printf("engine %.2f ms, C interface %.2f ms, median of the ratios of %d rounds %.4f; pixels %s\n",
              median(engine), median(interface), rounds, median(ratio), same ? "equal" : "DIFFER");
  afterglow_stack_free(stack);
  afterglow_device_free(device);
  return same ? 0 : 1;
}
