// SPDX-License-Identifier: MIT
// A folder with a small preset, its effect and its shaders, and a session that follows them.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <functional>
#include <mutex>

#include "session/live_session.h"

namespace afterglow {

class LiveTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    auto device = Device::create({.device = "auto", .validate = true}, quiet_);
    ASSERT_TRUE(device) << device.error().text();
    device_ = std::move(*device);
  }
  static void TearDownTestSuite() { device_.reset(); }

  void SetUp() override {
    std::filesystem::remove_all(folder_);
    write_files();
  }
  void write_files() {
    write("effects/t.lua", effect("t"));
    write("shaders/t/tint.glsl", kTint);
    write("shaders/t/lib.glsl", kLibrary);
    save(2);
  }
  void TearDown() override {
    session_.reset();
    EXPECT_EQ(device_->validation_errors(), 0)
        << (device_->validation_messages().empty() ? "" : device_->validation_messages()[0]);
    std::filesystem::remove_all(folder_);
  }

  /// blur, a kernel of its own; then a tint that reads it.
  static std::string effect(const std::string& name) {
    return R"(local fx = require "afterglow"
return fx.effect {
  name = ")" +
           name + R"(", at = "post_process",
  settings = { gain = fx.float { min = 0, max = 100, default = 1 } },
  build = function(g, s, source)
    local blur = g:filter { source = source, size = source, filter = fx.filters.tent(), name = "blur" }
    return g:pass { shader = "t/tint", source = blur, gain = s.gain, name = "tint" }
  end,
})";
  }
  static constexpr const char* kLibrary = "vec3 tinted(vec3 c, float gain) { return c * gain; }\n";
  static constexpr const char* kTint =
      "#include \"lib.glsl\"\nuniform sampler2D source;\nuniform float gain;\n"
      "vec4 sample_at(ivec2 p) { vec4 c = fetch(source, p); return vec4(tinted(c.rgb, gain), c.a); }\n";

  void write(const std::string& name, const std::string& text) {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  void save(double gain) { write("look.lua", preset(gain)); }
  static std::string preset(double gain) {
    return "local fx = require \"afterglow\"\nreturn fx.stack {\n  fx.t { gain = " + std::to_string(gain) + " },\n}\n";
  }

  void open(LiveOptions options = {}) {
    options.stack.keep_images = true;
    options.notify = [this] {
      if (at_notify_) at_notify_();
      const std::lock_guard lock(mutex_);
      ++notified_;
      changed_.notify_all();
    };
    auto session = LiveSession::open(*device_, folder_ / "look.lua", options, diagnostics_);
    ASSERT_TRUE(session) << session.error().text();
    session_ = std::move(*session);
  }
  /// Without a watcher: what a test looks at is what `settle` has found.
  void open_unwatched() {
    LiveOptions options;
    options.follow = false;
    open(options);
  }
  LiveStack& live() { return session_->live(); }

  static Picture picture() {
    Picture p;
    p.color = Image(16, 8, 4);
    std::fill(p.color.pixels.begin(), p.color.pixels.end(), 0.5f);
    note_content(p);
    return p;
  }
  /// The red of all pixels, which the effect keeps the same: 0.5 · gain.
  float shown() {
    static const Picture kPicture = picture();
    const auto done = session_->process(kPicture);
    EXPECT_TRUE(done) << done.error().text();
    if (!session_->images().ran) {  // the result is the source
      EXPECT_EQ(session_->images().result.binding.image, session_->images().source.binding.image);
      EXPECT_NE(session_->images().source.binding.image, VkImage{VK_NULL_HANDLE});
      return kPicture.color.pixels[0];
    }
    HostResult out;
    const auto read = session_->read_result(out);
    EXPECT_TRUE(read) << read.error().text();
    return out.pixels.empty() ? -1.f : out.pixels[0];
  }
  /// After every change on disk was built.
  float settled() {
    live().settle();
    return shown();
  }
  /// Waits until the watcher has brought a stack that shows this, or an error like this.
  bool comes(float value) {
    return wait_for([&] { return shown() == value && !live().status().error; });
  }
  bool fails(const std::string& part) {
    return wait_for([&] {
      shown();
      const auto status = live().status();
      return status.error && status.error_text().find(part) != std::string::npos;
    });
  }
  template <class Done>
  bool wait_for(Done&& done) {
    using namespace std::chrono_literals;
    const auto end = std::chrono::steady_clock::now() + 60s;
    while (true) {
      int before = 0;
      {
        const std::lock_guard lock(mutex_);
        before = notified_;
      }
      if (done()) return true;
      std::unique_lock lock(mutex_);
      if (!changed_.wait_until(lock, end, [&] { return notified_ != before; })) return false;
    }
  }

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("afterglow_live_" + std::to_string(getpid()));
  inline static Diagnostics quiet_;
  inline static std::unique_ptr<Device> device_;
  Diagnostics diagnostics_;
  std::mutex mutex_;
  std::condition_variable changed_;
  int notified_ = 0;
  std::function<void()> at_notify_;  ///< set before `open`
  std::unique_ptr<LiveSession> session_;
};

}  // namespace afterglow
