// SPDX-License-Identifier: MIT
// A host whose numbers have a decimal comma, as those of programs with windows have in half of Europe.
#include <clocale>
#include <cstdlib>
#include <thread>

#include "fixture.h"

namespace afterglow::test {
namespace {

class LocaleTest : public ApiTest {
 protected:
  void SetUp() override {
    ApiTest::SetUp();
    const std::string make = "localedef -i de_DE -f UTF-8 " + file("comma") + " >" + file("log") + " 2>&1";
    static_cast<void>(std::system(make.c_str()));  // its warnings are errors to it
    setenv("LOCPATH", folder_.c_str(), 1);
    ASSERT_NE(std::setlocale(LC_ALL, "comma"), nullptr) << "is the package `locales` installed?";
    ASSERT_STREQ(std::localeconv()->decimal_point, ",");
  }
  void TearDown() override {
    std::setlocale(LC_ALL, "C");
    unsetenv("LOCPATH");
    ApiTest::TearDown();
  }
  static std::string checked(int amount) {
    return "local fx = require \"afterglow\"\n"
           "assert(tostring(0.5) == \"0.5\" and string.format(\"%.2f\", 1.25) == \"1.25\" and 0.1 .. \"\" == \"0.1\")\n"
           "assert(tonumber(\"0.5\") == 0.5)\nreturn fx.stack { fx.gain { amount = " +
           std::to_string(amount) + ".5 } }\n";
  }
};

TEST_F(LocaleTest, NumbersInScriptsHaveAPoint) {
  write("look.lua", checked(1));
  const StackPtr made = stack();
  double amount = 0;
  ASSERT_TRUE(fine(afterglow_stack_get_number(made.get(), str("gain.amount"), &amount)));
  EXPECT_EQ(amount, 1.5);
  ASSERT_TRUE(fine(afterglow_stack_set(made.get(), str("gain.amount"), str("2.25"))));
  ASSERT_TRUE(fine(afterglow_stack_get_number(made.get(), str("gain.amount"), &amount)));
  EXPECT_EQ(amount, 2.25);
  EXPECT_STREQ(std::localeconv()->decimal_point, ",") << "the host's own stays";
}

TEST_F(LocaleTest, LooksThatAreFollowedAreBuiltAlike) {
  write("look.lua", checked(1));
  afterglow_stack_options options = listening();
  options.follow = true;
  const StackPtr made = stack(options);
  write("look.lua", checked(3));
  double amount = 0;
  for (int i = 0; i < 3000 && amount != 3.5; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    bool changed = false;
    ASSERT_TRUE(fine(afterglow_stack_update(made.get(), &changed)));
    ASSERT_TRUE(fine(afterglow_stack_get_number(made.get(), str("gain.amount"), &amount)));
  }
  EXPECT_EQ(amount, 3.5);
}

TEST_F(LocaleTest, TheHostsFunctionsHaveTheHostsLocale) {
  write("look.lua", "print(\"said\")\n" + checked(1));
  static std::string point;
  point.clear();
  afterglow_stack_options options = afterglow_stack_options_default();
  options.message = [](void*, afterglow_severity, afterglow_string) { point = std::localeconv()->decimal_point; };
  const StackPtr made = stack(options);
  EXPECT_EQ(point, ",");
}

}  // namespace
}  // namespace afterglow::test
