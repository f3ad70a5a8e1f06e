// SPDX-License-Identifier: MIT
// `requires` of a stack: the oldest Afterglow that runs it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene.h"
#include "script/requirement.h"

namespace afterglow::test {
namespace {

using script::newer_requirement;
using script::parse_version;
using testing::HasSubstr;

TEST(Requires, VersionsHaveTwoOrThreeNumbers) {
  EXPECT_EQ(parse_version("0.2"), (script::Version{0, 2, 0}));
  EXPECT_EQ(parse_version("1.10.3"), (script::Version{1, 10, 3}));
  for (const char* wrong : {"", "1", "a.b", "1.", ".1", "1.2.3.4", "1.-2", "1.2 ", "0x1.2", "99999999999.0"})
    EXPECT_FALSE(parse_version(wrong)) << wrong;
}

TEST(Requires, IsFoundInTextThatIsNotRun) {
  const script::Version own{0, 2, 0};
  const auto found = newer_requirement("a\n  requires = \"0.3\",", own);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->version, "0.3");
  EXPECT_EQ(found->line, 2);
  EXPECT_TRUE(newer_requirement("x { requires='0.2.1' }", own));
  for (const char* fits :
       {"requires = \"0.2\"", "requires = \"0.2.0\"", "requires = \"0.1.9\"", "-- requires = \"0.3\"",
        "not_requires = \"0.3\"", "local s = [[ requires = \"0.3\" ]]", "local s = 'requires = \"0.3\"'",
        "--[[\nrequires = \"0.3\"\n]]", "requires = 0.3", "requires \"0.3\"", "requires = \"0.3", "requires"})
    EXPECT_FALSE(newer_requirement(fits, own)) << fits;
}

TEST(Requires, NewerPresetsAreRefusedBeforeTheyRun) {
  Scene scene;
  scene.preset("local fx = require \"afterglow\"\nreturn fx.stack {\n  requires = \"9.0\",\n  fx.of_tomorrow {},\n}\n");
  EXPECT_THAT(scene.load_error(), HasSubstr("preset.lua:3: error: the preset requires Afterglow 9.0; this is 0."));
  scene.preset("local fx = require \"afterglow\"\nreturn fx.stack {\n  requires = \"soon\",\n}\n");
  EXPECT_EQ(
      scene.load_error(),
      "preset.lua:3: error: fx.stack: requires = \"soon\" is no version; allowed: \"0.2\" or \"0.2.1\": the oldest "
      "Afterglow that runs the preset");
  scene.preset("local fx = require \"afterglow\"\nreturn fx.stack { requires = \"0.2\" }\n");
  EXPECT_TRUE(scene.load().ok());
}

}  // namespace
}  // namespace afterglow::test
