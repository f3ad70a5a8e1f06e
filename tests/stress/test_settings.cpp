// Which settings are tried.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "bad_effects.h"
#include "stress/settings.h"

namespace afterglow::stress {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;

SettingSchema number(double low, double high, double by_default) {
  SettingSchema s{.name = "amount", .type = SettingType::number, .default_value = {.number = {by_default, 0, 0}}};
  s.min = low;
  s.max = high;
  return s;
}

std::vector<std::string> texts(const std::vector<SettingValue>& values) {
  std::vector<std::string> out;
  for (const auto& value : values) out.push_back(value.text());
  return out;
}

TEST(StressSettings, LimitsAndWhatLiesJustInside) {
  EXPECT_THAT(texts(hard_values(number(0, 1, 0.5))), ElementsAre("0", "1e-45", "0.99999994", "1"));
  EXPECT_THAT(texts(hard_values(number(0, 1, 0))), ElementsAre("1e-45", "0.99999994", "1"));
  SettingSchema whole = number(2, 12, 3);
  whole.type = whole.default_value.type = SettingType::integer;
  EXPECT_THAT(texts(hard_values(whole)), ElementsAre("2", "11", "12"));
  SettingSchema open{.name = "open", .type = SettingType::number};
  EXPECT_THAT(texts(hard_values(open)), Contains("1000000000000"));
  SettingSchema choice{.name = "mode", .type = SettingType::enumeration};
  choice.choices = {"a", "b", "c"};
  choice.default_value = {.type = SettingType::enumeration, .number = {}, .choice = "b"};
  EXPECT_THAT(texts(hard_values(choice)), ElementsAre("\"a\"", "\"c\""));
}

TEST(StressSettings, RandomOnesAreAllowedAndTheSameForTheSameSeed) {
  Random a(3), b(3);
  int at_limit = 0;
  for (int i = 0; i < 500; ++i) {
    const auto setting = number(-3, 700, 1);
    const auto value = random_value(setting, a);
    EXPECT_EQ(value, random_value(setting, b));
    EXPECT_TRUE(value.number[0] >= -3 && value.number[0] <= 700) << value.number[0];
    at_limit += value.number[0] == -3 || value.number[0] == 700;
  }
  EXPECT_GT(at_limit, 5);
}

/// Every effect of the library takes all that is tried on it, but for combinations that it refuses itself.
TEST(StressSettings, TheLibraryTakesWhatIsTried) {
  lab();
  Diagnostics quiet;
  const auto subjects = subjects_of_effects({}, {}, quiet);
  ASSERT_TRUE(subjects) << subjects.error().text();
  EXPECT_GT(subjects->size(), 25u);
  int refused = 0, tried = 0;
  for (const auto& subject : *subjects)
    for (const auto& look : subject.looks) {
      ++tried;
      const auto facts = lab().facts(look, {32, 32}, 1);
      refused += !facts;
      if (!facts) {
        EXPECT_EQ(facts.error().message.find("is not in"), std::string::npos) << facts.error().text();
      }
    }
  lab().forget();
  EXPECT_GT(tried, 300);
  EXPECT_LT(refused, tried / 20);
}

TEST(StressSettings, UnknownEffectsAreNamed) {
  lab();
  Diagnostics quiet;
  const auto subjects = subjects_of_effects({"blom"}, {}, quiet);
  ASSERT_FALSE(subjects);
  EXPECT_EQ(subjects.error().kind, ErrorKind::usage);
  EXPECT_EQ(subjects.error().nearest, "bloom");
}

}  // namespace
}  // namespace afterglow::stress
