// SPDX-License-Identifier: MIT
// A host that stays for days: frames, edits, sizes, presets and devices come and go, and leave no memory, handles or
// threads behind. AFTERGLOW_LONG=1 runs 100,000 frames and 10,000 presets in place of some.
#include <cstdlib>
#include <iostream>
#include <optional>

#include "fixture.h"
#include "resident.h"

namespace afterglow::test {
namespace {

std::size_t entries(const char* folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

/// What the process holds.
struct Held {
  std::size_t bytes = resident(), handles = entries("/proc/self/fd"), threads = entries("/proc/self/task");
};

/// `allowed`: bytes that allocators and the driver's own caches may come to.
void expect_flat(const Held& before, std::size_t allowed) {
  const Held after;
  std::cout << "memory " << (before.bytes >> 10) << " KiB, then " << (after.bytes >> 10) << " KiB; handles "
            << before.handles << ", " << after.handles << "; threads " << before.threads << ", " << after.threads
            << '\n';
#ifndef __SANITIZE_THREAD__  // ThreadSanitizer's own memory grows with all that is touched
  EXPECT_LT(after.bytes, before.bytes + allowed);
#endif
  EXPECT_LE(after.handles, before.handles);
  EXPECT_LE(after.threads, before.threads + 2) << "workers of a pool may begin late";
}

bool is_long() { return std::getenv("AFTERGLOW_LONG") != nullptr; }

class LongLived : public ApiTest {
 protected:
  /// A device of the test's own, which may go.
  void open_device() {
    afterglow_device_free(own_);
    own_ = nullptr;
    ASSERT_TRUE(fine(afterglow_device_open(nullptr, &own_)));
  }
  void TearDown() override {
    afterglow_device_free(own_);
    ApiTest::TearDown();
  }
  StackPtr stack_of(const std::string& text) {
    const std::string name = file("look.lua");
    afterglow_stack_options options = afterglow_stack_options_default();
    options.preset_file = str(name);
    options.preset_text = str(text);
    afterglow_stack* made = nullptr;
    EXPECT_TRUE(fine(afterglow_stack_create(own_, &options, &made)));
    return StackPtr(made);
  }
  void run(afterglow_stack* stack, int frame, int width, int height) {
    std::vector<float> in = pixels(width, height), out(in.size());
    afterglow_frame at = afterglow_frame_default();
    at.number = frame;
    afterglow_run_info info = afterglow_run_info_default();
    info.frame = &at;
    info.source = image(in, width, height);
    info.result = image(out, width, height);
    ASSERT_TRUE(fine(afterglow_stack_run(stack, &info))) << frame;
  }
  static std::string preset(const std::string& entries) {
    return "local fx = require \"afterglow\"\nreturn fx.stack { " + entries + " }\n";
  }
  afterglow_device* own_ = nullptr;
};

TEST_F(LongLived, FramesEditsSizesAndDevices) {
  const int frames = is_long() ? 100'000 : 1200, warm = is_long() ? 4000 : 600, devices = is_long() ? 1000 : 150;
  const char* const looks[] = {"fx.gain { amount = 2 }", "fx.gain { amount = 3 }, fx.vignette { intensity = 0.4 }",
                               "fx.bloom { intensity = 0.3 }, fx.tone_mapping {}",
                               "fx.auto_exposure {}, fx.gain { amount = 2, way = \"twice\" }"};
  std::optional<Held> before;
  StackPtr stack;
  for (int i = 0; i < frames; ++i) {
    if (i == warm) before.emplace();
    if (i % devices == 0) {  // what a host does whose device is lost
      stack.reset();
      open_device();
      stack = stack_of(preset(looks[0]));
    }
    const std::string look = preset(looks[i / 25 % 4]);
    if (i % 25 == 0) {
      ASSERT_TRUE(fine(afterglow_stack_reload(stack.get(), str(look))));
    }
    if (i % 100 == 99) {  // and one that is broken
      const std::string broken = preset("fx.gain { amount = nonsense }, 7");
      EXPECT_TRUE(ErrorPtr(afterglow_stack_reload(stack.get(), str(broken))));
    }
    if (i / 25 % 4 < 2) {
      ASSERT_TRUE(fine(afterglow_stack_set_number(stack.get(), afterglow_str("gain.amount"), i % 7)));
    }
    if (i / 25 % 4 < 2 && i % 25 == 24) {
      ASSERT_TRUE(fine(afterglow_stack_unset(stack.get(), afterglow_str("gain.amount"))));
    }
    run(stack.get(), i, 8 + i / 10 % 5, 8 + i / 30 % 3);
  }
  expect_flat(*before, is_long() ? 32u << 20 : 24u << 20);
}

TEST_F(LongLived, LooksThatRunOnceAndGo) {
  // As thumbnails do: nothing else runs on the device. lavapipe would keep 5 MB of each.
  open_device();
  std::optional<Held> before;
  for (int i = 0; i < 40; ++i) {
    if (i == 10) before.emplace();
    run(stack_of(preset("fx.bloom {}")).get(), 1, 64, 48);
  }
  expect_flat(*before, 32u << 20);
}

TEST_F(LongLived, PresetsOneAfterTheOther) {
  // The driver keeps what it compiles for a device within bounds of its own, which it takes some hundreds to reach.
  const int presets = is_long() ? 10'000 : 240, warm = is_long() ? 2000 : 120;
  open_device();
  std::optional<Held> before;
  for (int i = 0; i < presets; ++i) {
    if (i == warm) before.emplace();
    std::string entries = "fx.gain { amount = " + std::to_string(i) + " }";
    if (i % 3 == 1) entries += ", fx.vignette { intensity = 0." + std::to_string(i) + " }";
    if (i % 4 == 2) entries += ", fx.tone_mapping {}";
    if (i % 10 == 0) {  // a shader that no other has
      write("shaders/gain/gain.glsl",
            "uniform float amount;\nuniform vec3 tint;\nvec4 apply(vec4 color) { return vec4("
            "color.rgb * amount * tint + " +
                std::to_string(i) + ".0, color.a); }\n");
    }
    run(stack_of(preset(entries)).get(), 1, 8, 8);
  }
  expect_flat(*before, is_long() ? 48u << 20 : 16u << 20);
}

}  // namespace
}  // namespace afterglow::test
