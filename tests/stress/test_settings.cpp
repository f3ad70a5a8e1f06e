// SPDX-License-Identifier: MIT
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

TEST(StressSettings, RandomCompositionsLoadAndAreShrunkByOne) {
  Diagnostics quiet;
  auto subjects = subjects_of_effects({"composition"}, {}, quiet);
  ASSERT_TRUE(subjects) << subjects.error().text();
  ASSERT_EQ(subjects->size(), 1u);
  std::erase_if(subjects->back().composed, [](const EffectSchema& effect) {
    return effect.name != "color_adjustments" && effect.name != "exposure" && effect.name != "vignette";
  });
  int groups = 0, masks = 0;
  for (std::uint64_t i = 0; i < 200; ++i) {
    Random random(11, i);
    Look look{random_composition(subjects->back().composed, subjects->back().masks, search_path_for({}, {}), random),
              {}};
    const auto facts = harness().facts(look, {16, 16}, 1);
    EXPECT_TRUE(facts) << look.line() << "\n" << facts.error().text();
    groups += look.text().find("fx.group") != std::string::npos;
    masks += look.text().find("fx.mask") != std::string::npos;
    while (look.entries.size() > 1) {
      const std::size_t count = look.entries.size();
      look = look.without(random.below(count));
      ASSERT_EQ(look.entries.size(), count - 1);
      EXPECT_TRUE(harness().facts(look, {16, 16}, 1)) << look.line();
    }
  }
  EXPECT_GT(groups, 20);
  EXPECT_GT(masks, 50);
}

TEST(StressSettings, TheTextOfGroups) {
  const auto entry = [](const char* effect, int depth) {
    LookEntry out{.effect = effect, .settings = {}, .at = {}};
    out.depth = depth;
    return out;
  };
  Look look{{entry("a", 0), entry("group", 0), entry("b", 1), entry("group", 1), entry("c", 2), entry("d", 0)}, {}};
  look.entries[1].composition = {{"opacity", "0.5"}};
  EXPECT_EQ(look.line(), "fx.a {}, fx.group { opacity = 0.5, fx.b {}, fx.group { fx.c {} } }, fx.d {}");
  EXPECT_EQ(look.without(1).line(), "fx.a {}, fx.b {}, fx.group { fx.c {} }, fx.d {}");
  EXPECT_TRUE(look.is_composed());
}

/// Every effect of the library takes all that is tried on it, but for combinations that it refuses itself.
TEST(StressSettings, TheLibraryTakesWhatIsTried) {
  harness();
  Diagnostics quiet;
  const auto subjects = subjects_of_effects({}, {}, quiet);
  ASSERT_TRUE(subjects) << subjects.error().text();
  EXPECT_GT(subjects->size(), 25u);
  int refused = 0, tried = 0;
  for (const auto& subject : *subjects)
    for (const auto& look : subject.looks) {
      ++tried;
      const auto facts = harness().facts(look, {32, 32}, 1);
      refused += !facts;
      if (!facts) {
        EXPECT_EQ(facts.error().message.find("is not in"), std::string::npos) << facts.error().text();
      }
    }
  harness().forget();
  EXPECT_GT(tried, 300);
  EXPECT_LT(refused, tried / 20);
}

TEST(StressSettings, UnknownEffectsAreNamed) {
  harness();
  Diagnostics quiet;
  const auto subjects = subjects_of_effects({"blom"}, {}, quiet);
  ASSERT_FALSE(subjects);
  EXPECT_EQ(subjects.error().kind, ErrorKind::usage);
  EXPECT_EQ(subjects.error().nearest, "bloom");
}

}  // namespace
}  // namespace afterglow::stress
