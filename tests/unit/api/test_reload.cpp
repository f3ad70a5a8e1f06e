// SPDX-License-Identifier: MIT
// Presets from files and texts, loaded again, followed.
#include <condition_variable>
#include <mutex>

#include "fixture.h"

namespace afterglow::test {
namespace {

/// Counts wakes; the waiting test sleeps meanwhile.
struct Waker {
  std::mutex mutex;
  std::condition_variable changed;
  int wakes = 0;
  static void wake(void* user) {
    auto* self = static_cast<Waker*>(user);
    const std::lock_guard lock(self->mutex);
    ++self->wakes;
    self->changed.notify_all();
  }
  void wait_for_more(int than) {
    std::unique_lock lock(mutex);
    ASSERT_TRUE(changed.wait_for(lock, std::chrono::minutes(2), [&] { return wakes > than; }));
  }
  int count() {
    const std::lock_guard lock(mutex);
    return wakes;
  }
};

class ReloadTest : public ApiTest {
 protected:
  /// Runs a frame of one pixel, 0.5. `first`: the first sample of what came of it.
  static ErrorPtr run_frame(const StackPtr& stack, double number, float* first = nullptr) {
    std::vector<float> source(4, 0.5f), result(4);
    afterglow_run_info info = afterglow_run_info_default();
    afterglow_frame frame = afterglow_frame_default();
    frame.number = number;
    info.frame = &frame;
    info.source = image(source, 1, 1);
    info.result = image(result, 1, 1);
    ErrorPtr error(afterglow_stack_run(stack.get(), &info));
    if (first) *first = result[0];
    return error;
  }
  static float first_sample(const StackPtr& stack) {
    float sample = 0;
    EXPECT_TRUE(fine(run_frame(stack, afterglow_frame_default().number, &sample).release()));
    return sample;
  }
  /// Updates until something was taken or an error came.
  static ErrorPtr update(const StackPtr& stack, Waker& waker) {
    for (;;) {
      const int before = waker.count();
      bool changed = false;
      ErrorPtr error(afterglow_stack_update(stack.get(), &changed));
      if (error || changed) return error;
      waker.wait_for_more(before);
      if (HasFatalFailure()) return {};
    }
  }
};

TEST_F(ReloadTest, FilesAreReadAgainWhenAsked) {
  const StackPtr stack = this->stack();
  EXPECT_FLOAT_EQ(first_sample(stack), 1.0f);
  look("fx.gain { amount = 4 }");
  EXPECT_FLOAT_EQ(first_sample(stack), 1.0f);
  ASSERT_TRUE(fine(afterglow_stack_reload(stack.get(), afterglow_str(nullptr))));
  EXPECT_FLOAT_EQ(first_sample(stack), 2.0f);

  // A broken one leaves the last good one; what was set stays.
  ASSERT_TRUE(fine(afterglow_stack_set_number(stack.get(), str("gain.amount"), 8)));
  look("fx.gain { amount = ");
  const ErrorPtr error(afterglow_stack_reload(stack.get(), afterglow_str(nullptr)));
  EXPECT_EQ(afterglow_error_get_kind(error.get()), AFTERGLOW_ERROR_SCRIPT);
  EXPECT_EQ(afterglow_error_get_line(error.get()), 2);
  EXPECT_FLOAT_EQ(first_sample(stack), 4.0f);
  look("fx.gain { amount = 1 }");
  ASSERT_TRUE(fine(afterglow_stack_reload(stack.get(), afterglow_str(nullptr))));
  EXPECT_FLOAT_EQ(first_sample(stack), 4.0f);
}

/// Also one that is too large to be kept as a text (core/file_record.h): what was made of it is.
TEST_F(ReloadTest, ATableThatWasReadIsNotReadAgain) {
  constexpr std::size_t kLarge = 65u << 20;
  write("large.cube", std::string(kLarge, '#') + "\nLUT_1D_SIZE 2\n0 0 0\n0.5 0.5 0.5\n");
  look("fx.gain { amount = 1 }, fx.lut { file = \"large.cube\" }");
  const StackPtr stack = this->stack();
  std::vector<float> source = pixels(4, 4), before(source.size()), result(source.size());
  afterglow_run_info info = afterglow_run_info_default();
  info.source = image(source, 4, 4);
  info.result = image(before, 4, 4);
  ASSERT_TRUE(fine(afterglow_stack_run(stack.get(), &info)));
  fs::remove(file("large.cube"));
  info.result = image(result, 4, 4);
  ASSERT_TRUE(fine(afterglow_stack_set_number(stack.get(), str("gain.amount"), 2)));
  ASSERT_TRUE(fine(afterglow_stack_run(stack.get(), &info)));
  EXPECT_NE(result, before);
}

TEST_F(ReloadTest, FilesAreReadWhenAskedAndNeverElse) {
  write("parts.lua", "return { amount = 2 }\n");
  const std::string preset =
      "local fx, parts = require 'afterglow', require 'parts'\nreturn fx.stack { fx.gain { amount = parts.amount } }\n";
  write("look.lua", preset);
  const StackPtr stack = this->stack();
  EXPECT_FLOAT_EQ(first_sample(stack), 1.0f);

  // Edits that are not finished: a setting is set as if they were not there.
  look("fx.gain { amount = ");
  write("parts.lua", "return {");
  write("effects/gain.lua", "return");
  write("shaders/gain/gain.glsl", "vec4");
  ASSERT_TRUE(fine(afterglow_stack_set_text(stack.get(), str("gain.way"), str("twice"))));
  EXPECT_FLOAT_EQ(first_sample(stack), 2.0f);
  for (const char* name : {"look.lua", "parts.lua", "effects/gain.lua", "shaders/gain/gain.glsl"})
    fs::remove(folder_ / name);
  ASSERT_TRUE(fine(afterglow_stack_set_number(stack.get(), str("gain.amount"), 3)));
  EXPECT_FLOAT_EQ(first_sample(stack), 4.5f);
  EXPECT_TRUE(ErrorPtr(afterglow_stack_reload(stack.get(), afterglow_str(nullptr))));
  ASSERT_TRUE(fine(afterglow_stack_unset(stack.get(), afterglow_str(nullptr))));
  EXPECT_FLOAT_EQ(first_sample(stack), 1.0f);
}

TEST_F(ReloadTest, WhatThePresetNoLongerHasIsLeftOut) {
  for (const bool follow : {false, true}) {
    look("fx.gain { amount = 2 }, fx.trim {}");
    write(
        "effects/trim.lua",
        "local fx = require 'afterglow'\nreturn fx.effect { name = 'trim', doc = '.', at = 'post_process', order = 1,\n"
        "settings = { by = fx.float { default = 1, min = 0, max = 9, doc = '.' } },\n"
        "build = function(g, s, source) return g:pass { shader = 'gain/gain', source = source, amount = s.by, tint = "
        "{ 1, 1, 1 } } end }\n");
    afterglow_stack_options options = listening();
    messages_.clear();
    options.follow = follow;
    const StackPtr stack = this->stack(options);
    ASSERT_TRUE(fine(afterglow_stack_set_number(stack.get(), str("trim.by"), 2)));
    EXPECT_FLOAT_EQ(first_sample(stack), 2.0f);
    look("fx.gain { amount = 2 }");
    ASSERT_TRUE(fine(afterglow_stack_reload(stack.get(), afterglow_str(nullptr))));
    EXPECT_FLOAT_EQ(first_sample(stack), 1.0f);
    for (const double amount : {3.0, 4.0, 5.0})
      ASSERT_TRUE(fine(afterglow_stack_set_number(stack.get(), str("gain.amount"), amount)));
    EXPECT_FLOAT_EQ(first_sample(stack), 2.5f);
    EXPECT_THAT(messages_, testing::ElementsAre(HasSubstr("the stack has no entry 'trim'")));
    EXPECT_TRUE(ErrorPtr(afterglow_stack_set_number(stack.get(), str("trim.by"), 3)));
    look("fx.gain { amount = 2 }, fx.trim {}");
    ASSERT_TRUE(fine(afterglow_stack_reload(stack.get(), afterglow_str(nullptr))));
    EXPECT_FLOAT_EQ(first_sample(stack), 5.0f);
  }
}

/// What a preset prints is told once, and again when it prints something else.
TEST_F(ReloadTest, WhatScriptsPrintIsTold) {
  const auto printing = [&](const char* word) {
    write("look.lua", std::string("local fx = require \"afterglow\"\nprint(\"") + word +
                          "\")\nreturn fx.stack { fx.gain { amount = 2 } }\n");
  };
  for (const bool follow : {false, true}) {
    printing("first");
    afterglow_stack_options options = listening();
    messages_.clear();
    options.follow = follow;
    const StackPtr stack = this->stack(options);
    EXPECT_THAT(messages_, testing::ElementsAre(HasSubstr("look.lua:2: first")));
    EXPECT_FLOAT_EQ(first_sample(stack), 1.0f);
    for (const double amount : {3.0, 4.0, 5.0})
      ASSERT_TRUE(fine(afterglow_stack_set_number(stack.get(), str("gain.amount"), amount)));
    EXPECT_TRUE(ErrorPtr(afterglow_stack_set_number(stack.get(), str("gain.amonut"), 1)));
    EXPECT_FLOAT_EQ(first_sample(stack), 2.5f);
    EXPECT_EQ(messages_.size(), 1u);
    printing("second");
    ASSERT_TRUE(fine(afterglow_stack_reload(stack.get(), afterglow_str(nullptr))));
    EXPECT_THAT(messages_, testing::ElementsAre(HasSubstr("first"), HasSubstr("look.lua:2: second")));
  }
}

/// Paths that are given are those of the working directory at that time.
TEST_F(ReloadTest, AHostMayChangeItsWorkingDirectory) {
  const fs::path home = fs::current_path();
  fs::create_directories(file("here"));
  fs::create_directories(file("more"));
  fs::rename(file("effects"), file("more/effects"));
  fs::rename(file("shaders"), file("more/shaders"));
  fs::create_directory_symlink(AFTERGLOW_PROJECT_FOLDER, file("installation"));
  const std::string text = "local fx = require 'afterglow'\nreturn fx.stack { fx.gain { amount = 2 } }\n";
  for (const bool follow : {false, true})
    for (const bool of_text : {false, true}) {
      if (follow && of_text) continue;
      SCOPED_TRACE(testing::Message() << follow << of_text);
      look("fx.gain { amount = 2 }");
      fs::current_path(file("here"));
      const afterglow_string more = afterglow_str("../more");
      afterglow_stack_options options = afterglow_stack_options_default();
      options.preset_file = afterglow_str("../look.lua");
      if (of_text) options.preset_text = str(text);
      options.paths = &more;
      options.path_count = 1;
      options.installation = afterglow_str("../installation");
      options.follow = follow;
      const StackPtr stack = this->stack(options);
      fs::current_path(folder_);
      EXPECT_FLOAT_EQ(first_sample(stack), 1.0f);
      EXPECT_TRUE(fine(afterglow_stack_set_number(stack.get(), str("gain.amount"), 8)));
      EXPECT_FLOAT_EQ(first_sample(stack), 4.0f);
      EXPECT_TRUE(fine(afterglow_stack_unset(stack.get(), afterglow_str(nullptr))));
      look("fx.gain { amount = 4 }");
      EXPECT_TRUE(fine(afterglow_stack_reload(stack.get(), afterglow_str(nullptr))));
      EXPECT_FLOAT_EQ(first_sample(stack), of_text ? 1.0f : 2.0f);
      fs::current_path(home);
    }
}

TEST_F(ReloadTest, ADevicesCacheStaysWhereItWas) {
  const fs::path home = fs::current_path();
  fs::create_directories(file("here"));
  fs::create_directories(file("there"));
  fs::current_path(file("here"));
  afterglow_device_options options = afterglow_device_options_default();
  options.cache_folder = afterglow_str("cache");
  afterglow_device* device = nullptr;
  ASSERT_TRUE(fine(afterglow_device_open(&options, &device)));
  fs::current_path(file("there"));
  const std::string look = file("look.lua");
  afterglow_stack_options wanted = afterglow_stack_options_default();
  wanted.preset_file = str(look);
  afterglow_stack* made = nullptr;
  EXPECT_TRUE(fine(afterglow_stack_create(device, &wanted, &made)));
  EXPECT_FLOAT_EQ(first_sample(StackPtr(made)), 1.0f);
  afterglow_device_free(device);
  fs::current_path(home);
  EXPECT_TRUE(fs::exists(file("here/cache/shaders")));
  EXPECT_TRUE(fs::is_empty(file("there")));
}

TEST_F(ReloadTest, APresetMayBeAText) {
  afterglow_stack_options options = afterglow_stack_options_default();
  const std::string name = file("never_written.lua");
  const auto text = [](const char* amount) {
    return std::string("local fx = require \"afterglow\"\nreturn fx.stack { fx.gain { amount = ") + amount + " } }\n";
  };
  std::string preset = text("6");
  options.preset_file = str(name);
  options.preset_text = str(preset);
  const StackPtr stack = this->stack(options);
  preset.assign(preset.size(), '!');  // it was copied
  EXPECT_FLOAT_EQ(first_sample(stack), 3.0f);
  ASSERT_TRUE(fine(afterglow_stack_reload(stack.get(), str(text("10")))));
  EXPECT_FLOAT_EQ(first_sample(stack), 5.0f);
  const ErrorPtr error(afterglow_stack_reload(stack.get(), str(text("\"ten\""))));
  EXPECT_EQ(str(afterglow_error_get_file(error.get())), name);
  EXPECT_EQ(afterglow_error_get_line(error.get()), 2);
  EXPECT_FLOAT_EQ(first_sample(stack), 5.0f);

  options.preset_text = afterglow_str("return nil");
  options.preset_file = afterglow_str("a look of mine");
  EXPECT_EQ(str(afterglow_error_get_file(broken(options).get())), "a look of mine");
  options.preset_file = afterglow_str("");
  EXPECT_THAT(text_of(broken(options).get()), HasSubstr("preset_file is empty"));
  options.preset_text = {};
  const ErrorPtr empty = broken(options);
  EXPECT_EQ(afterglow_error_get_kind(empty.get()), AFTERGLOW_ERROR_USAGE);
  options.preset_file = str(name);

  options.preset_text = afterglow_str("return nil");
  options.follow = true;
  EXPECT_EQ(afterglow_error_get_kind(broken(options).get()), AFTERGLOW_ERROR_USAGE);
}

TEST_F(ReloadTest, EditsOfAFollowedFileAreTakenByUpdate) {
  Waker waker;
  afterglow_stack_options options = afterglow_stack_options_default();
  options.follow = true;
  options.wake = Waker::wake;
  options.user = &waker;
  const StackPtr stack = this->stack(options);
  EXPECT_FLOAT_EQ(first_sample(stack), 1.0f);

  look("fx.gain { amount = 4 }");
  ASSERT_FALSE(update(stack, waker));
  EXPECT_FLOAT_EQ(first_sample(stack), 2.0f);

  // A broken edit is told once, and the last good one stays.
  look("fx.gain { amount = \"many\" }");
  const ErrorPtr error = update(stack, waker);
  EXPECT_EQ(afterglow_error_get_kind(error.get()), AFTERGLOW_ERROR_SCRIPT);
  EXPECT_EQ(afterglow_error_get_line(error.get()), 2);
  EXPECT_TRUE(afterglow_stack_runs(stack.get()));
  EXPECT_TRUE(fine(afterglow_stack_update(stack.get(), nullptr)));
  EXPECT_FLOAT_EQ(first_sample(stack), 2.0f);

  look("fx.gain { amount = 6 }");
  ASSERT_FALSE(update(stack, waker));
  EXPECT_FLOAT_EQ(first_sample(stack), 3.0f);

  // Settings stand above edits, and are refused as in a stack that follows nothing.
  ASSERT_TRUE(fine(afterglow_stack_set_number(stack.get(), str("gain.amount"), 8)));
  EXPECT_FLOAT_EQ(first_sample(stack), 4.0f);
  const ErrorPtr refused(afterglow_stack_set_number(stack.get(), str("gain.amonut"), 8));
  EXPECT_EQ(str(afterglow_error_get_nearest(refused.get())), "amount");
  EXPECT_FLOAT_EQ(first_sample(stack), 4.0f);
  ASSERT_TRUE(fine(afterglow_stack_unset(stack.get(), str("gain.amount"))));
  EXPECT_FLOAT_EQ(first_sample(stack), 3.0f);

  look("fx.gain { amount = 10 }");
  ASSERT_TRUE(fine(afterglow_stack_reload(stack.get(), afterglow_str(nullptr))));
  EXPECT_FLOAT_EQ(first_sample(stack), 5.0f);
}

const std::string kDark = "LUT_1D_SIZE 2\n0 0 0\n0.25 0.25 0.25\n";

/// What is set while a table is broken counts from the next good edit on, and can be taken back.
TEST_F(ReloadTest, WhatIsSetWhileATableIsBrokenIsKept) {
  write("dark.cube", kDark);
  look("fx.gain { amount = 2 }, fx.lut { file = \"dark.cube\" }");
  Waker waker;
  afterglow_stack_options options = afterglow_stack_options_default();
  options.follow = true;
  options.wake = Waker::wake;
  options.user = &waker;
  const StackPtr stack = this->stack(options);
  const float dark = first_sample(stack);
  EXPECT_LT(dark, 0.5f);
  write("dark.cube", "garbage");
  ASSERT_TRUE(update(stack, waker));
  ASSERT_TRUE(fine(afterglow_stack_set_number(stack.get(), str("lut.opacity"), 0.5)));
  ASSERT_TRUE(fine(afterglow_stack_set_number(stack.get(), str("gain.amount"), 3)));
  ASSERT_TRUE(fine(afterglow_stack_unset(stack.get(), str("gain.amount"))));
  EXPECT_EQ(first_sample(stack), dark) << "the last good one";
  write("dark.cube", kDark + "\n");
  while (first_sample(stack) == dark && !HasFatalFailure()) (void)update(stack, waker);  // half written it is an error
  EXPECT_FLOAT_EQ(first_sample(stack), (1.0f + dark) / 2);
  ASSERT_TRUE(fine(afterglow_stack_unset(stack.get(), afterglow_str(nullptr))));
  EXPECT_EQ(first_sample(stack), dark);
}

/// A file that is gone, or names none: the last good look runs on.
TEST_F(ReloadTest, FilesThatAreNotThereLeaveTheLastGoodLook) {
  for (const bool follow : {false, true}) {
    SCOPED_TRACE(follow);
    write("dark.cube", kDark);
    look("fx.gain { amount = 2 }, fx.lut { file = \"dark.cube\" }");
    Waker waker;
    afterglow_stack_options options = afterglow_stack_options_default();
    options.follow = follow;
    options.wake = follow ? Waker::wake : nullptr;
    options.user = &waker;
    const StackPtr stack = this->stack(options);
    const float dark = first_sample(stack);
    // Settings that belong together are set one after the other: what only a frame can tell is told by it.
    ASSERT_TRUE(fine(afterglow_stack_set_text(stack.get(), str("lut.file"), str("none.cube"))));
    const ErrorPtr told = follow ? update(stack, waker) : run_frame(stack, 1);
    EXPECT_THAT(text_of(told.get()), HasSubstr("none.cube"));
    if (follow) {
      EXPECT_EQ(first_sample(stack), dark);
    }
    ASSERT_TRUE(fine(afterglow_stack_set_number(stack.get(), str("gain.amount"), 2)));
    ASSERT_TRUE(fine(afterglow_stack_unset(stack.get(), str("lut.file"))));
    EXPECT_EQ(first_sample(stack), dark);
    fs::remove(folder_ / "dark.cube");
    EXPECT_EQ(follow && update(stack, waker), follow);
    EXPECT_EQ(first_sample(stack), dark);
    EXPECT_TRUE(ErrorPtr(afterglow_stack_reload(stack.get(), afterglow_str(nullptr))));
    EXPECT_EQ(first_sample(stack), dark);
    write("dark.cube", kDark);
    ASSERT_TRUE(fine(afterglow_stack_reload(stack.get(), afterglow_str(nullptr))));
    EXPECT_EQ(first_sample(stack), dark);
  }
}

/// A frame that failed is nothing that later calls are held to.
TEST_F(ReloadTest, AFrameThatFailsIsNoReasonToRefuse) {
  for (const bool follow : {false, true}) {
    SCOPED_TRACE(follow);
    look("fx.gain { amount = function(t) if t.frame > 5 then error('no such frame') end return 2 end }");
    afterglow_stack_options options = afterglow_stack_options_default();
    options.follow = follow;
    const StackPtr stack = this->stack(options);
    EXPECT_FLOAT_EQ(first_sample(stack), 1.0f);
    EXPECT_TRUE(run_frame(stack, 9));
    ASSERT_TRUE(fine(afterglow_stack_set_text(stack.get(), str("gain.way"), str("twice"))));
    EXPECT_FLOAT_EQ(first_sample(stack), 2.0f);
    EXPECT_TRUE(run_frame(stack, 9));
    ASSERT_TRUE(fine(afterglow_stack_reload(stack.get(), afterglow_str(nullptr))));
    EXPECT_FLOAT_EQ(first_sample(stack), 2.0f);
  }
}

TEST_F(ReloadTest, AShaderThatIsBrokenIsToldByReload) {
  const StackPtr stack = this->stack();
  EXPECT_FLOAT_EQ(first_sample(stack), 1.0f);
  write("shaders/gain/gain.glsl",
        "uniform float amount;\nuniform vec3 tint;\nvec4 apply(vec4 color) { return amuont; }\n");
  EXPECT_TRUE(ErrorPtr(afterglow_stack_reload(stack.get(), afterglow_str(nullptr))));
  EXPECT_FLOAT_EQ(first_sample(stack), 1.0f);
  write("shaders/gain/gain.glsl",
        "uniform float amount;\nuniform vec3 tint;\n"
        "vec4 apply(vec4 color) { return vec4(color.rgb * amount * tint * 4.0, color.a); }\n");
  ASSERT_TRUE(fine(afterglow_stack_reload(stack.get(), afterglow_str(nullptr))));
  EXPECT_FLOAT_EQ(first_sample(stack), 4.0f);
}

/// Values are those of the last frame, whatever was set since.
TEST_F(ReloadTest, ValuesAreThoseOfTheLastFrame) {
  for (const bool follow : {false, true}) {
    SCOPED_TRACE(follow);
    look("fx.gain { amount = function(t) return t.frame end }");
    afterglow_stack_options options = afterglow_stack_options_default();
    options.follow = follow;
    const StackPtr stack = this->stack(options);
    ASSERT_FALSE(run_frame(stack, 9));
    const auto amount = [&] {
      double value = 0;
      EXPECT_TRUE(fine(afterglow_stack_get_number(stack.get(), str("gain.amount"), &value)));
      return value;
    };
    EXPECT_EQ(amount(), 9);
    ASSERT_TRUE(fine(afterglow_stack_set_text(stack.get(), str("gain.way"), str("twice"))));
    EXPECT_EQ(amount(), 9);
    ASSERT_TRUE(fine(afterglow_stack_unset(stack.get(), afterglow_str(nullptr))));
    ASSERT_TRUE(fine(afterglow_stack_reload(stack.get(), afterglow_str(nullptr))));
    EXPECT_EQ(amount(), 9);
  }
}

TEST_F(ReloadTest, ABrokenPresetCannotBeFollowed) {
  look("fx.gain { amount = \"many\" }");
  afterglow_stack_options options = afterglow_stack_options_default();
  options.follow = true;
  EXPECT_EQ(afterglow_error_get_kind(broken(options).get()), AFTERGLOW_ERROR_SCRIPT);
}

TEST_F(ReloadTest, TheInstallationMayBeNamed) {
  write("empty/scripts/afterglow.lua", "error('another installation')\n");
  afterglow_stack_options options = afterglow_stack_options_default();
  const std::string elsewhere = file("empty");
  options.installation = str(elsewhere);
  EXPECT_THAT(text_of(broken(options).get()), HasSubstr("another installation"));
  const std::string project = AFTERGLOW_PROJECT_FOLDER;
  options.installation = str(project);
  EXPECT_FLOAT_EQ(first_sample(stack(options)), 1.0f);
}

}  // namespace
}  // namespace afterglow::test
