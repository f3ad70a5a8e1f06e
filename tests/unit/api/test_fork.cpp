// SPDX-License-Identifier: MIT
// Processes that fork: what the parent opened is not theirs.
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "fixture.h"

namespace afterglow::test {
namespace {

/// What `work` says (0: all is well), done in a child process that an alarm ends if it hangs.
template <class Work>
int in_child(Work work) {
  const pid_t child = fork();
  if (child == 0) {
    alarm(60);
    _exit(work());
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

bool is_refused(afterglow_error* error) {
  const ErrorPtr owner(error);
  return afterglow_error_get_kind(error) == AFTERGLOW_ERROR_DEVICE &&
         text_of(error).find("opened before fork()") != std::string::npos;
}

class ForkTest : public ApiTest {
 protected:
  void SetUp() override {
    ApiTest::SetUp();
    // Without the layer, which has threads and locks of its own.
    ASSERT_TRUE(fine(afterglow_device_open(nullptr, &own_)));
  }
  void TearDown() override {
    afterglow_device_free(own_);
    ApiTest::TearDown();
  }
  afterglow_stack* made(bool follow) const {
    const std::string look = file("look.lua");
    afterglow_stack_options options = afterglow_stack_options_default();
    options.preset_file = str(look);
    options.follow = follow;
    afterglow_stack* out = nullptr;
    EXPECT_TRUE(fine(afterglow_stack_create(own_, &options, &out)));
    return out;
  }
  static afterglow_error* run(afterglow_stack* stack) {
    std::vector<float> in = pixels(16, 9), out(in.size());
    afterglow_run_info info = afterglow_run_info_default();
    info.source = image(in, 16, 9);
    info.result = image(out, 16, 9);
    return afterglow_stack_run(stack, &info);
  }
  afterglow_device* own_ = nullptr;
};

TEST_F(ForkTest, TheChildIsRefusedAndMayFree) {
  for (const bool follow : {false, true}) {
    afterglow_stack* stack = made(follow);
    ASSERT_TRUE(fine(run(stack)));
    const int told = in_child([&] {
      afterglow_text* text = nullptr;
      bool changed = false;
      const std::string look = file("look.lua");
      afterglow_stack_options options = afterglow_stack_options_default();
      options.preset_file = str(look);
      afterglow_stack* another = nullptr;
      if (!is_refused(run(stack))) return 1;
      if (!is_refused(afterglow_stack_settings(stack, &text))) return 2;
      if (!is_refused(afterglow_stack_set_number(stack, str("gain.amount"), 3))) return 3;
      if (!is_refused(afterglow_stack_update(stack, &changed))) return 4;
      if (!is_refused(afterglow_device_describe(own_, &text))) return 5;
      if (!is_refused(afterglow_stack_create(own_, &options, &another)) || another) return 6;
      afterglow_stack_reset_history(stack);
      afterglow_stack_free(stack);
      afterglow_device_free(own_);
      return 0;
    });
    EXPECT_EQ(told, 0) << follow;
    EXPECT_TRUE(fine(run(stack))) << "the parent goes on";
    afterglow_stack_free(stack);
  }
}

}  // namespace
}  // namespace afterglow::test
