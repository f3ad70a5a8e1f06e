// SPDX-License-Identifier: MIT
// A case that was kept is the same case when it is read again.
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "bad_effects.h"
#include "core/file.h"
#include "core/process.h"
#include "stress/reproducer.h"

namespace afterglow::stress {
namespace {

TEST(StressReproducer, ComesBackToTheBit) {
  const EffectFolder folder;
  folder.effect("broken",
                "vec4 apply(vec4 color) { return strength > 0.8 && color.r > 20.0 ? vec4(1.0 / (color.r - color.r)) : "
                "color * level; }");
  Look look = folder.look("broken");
  look.entries.front().set("strength", {.type = SettingType::number, .number = {0.9, 0, 0}});
  Situation kept = situation(look, "finite", {"spike", {20, 10}, 2});
  kept.frame = 17;
  const Outcome outcome = outcome_of(kept);
  ASSERT_FALSE(outcome.holds);
  const auto place = folder.path() / "kept case";
  ASSERT_TRUE(write_reproducer(place, kept, outcome, {"1.2.3", "a device", "a driver", 7, 12}));

  Diagnostics quiet;
  const auto read = read_reproducer(place, quiet);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->look.text(), kept.look.text());
  EXPECT_EQ(read->look.paths, kept.look.paths);
  EXPECT_EQ(read->check, kept.check);
  EXPECT_EQ(read->seed, kept.seed);
  EXPECT_EQ(read->frame, kept.frame);
  ASSERT_EQ(read->picture.color.pixels.size(), kept.picture.color.pixels.size());
  EXPECT_EQ(
      std::memcmp(read->picture.color.pixels.data(), kept.picture.color.pixels.data(), kept.picture.color.bytes()), 0);
  for (const char* name : {"depth", "normal", "motion"})
    EXPECT_EQ(read->picture.auxiliary.at(name).pixels, kept.picture.auxiliary.at(name).pixels) << name;
  const Outcome again = outcome_of(*read);
  EXPECT_FALSE(again.holds);
  EXPECT_EQ(again.what, outcome.what);

  const auto text = nlohmann::json::parse(read_file(place / "case.json").value());
  EXPECT_EQ(text["found"]["seed"], 7);
  EXPECT_THAT(std::string(text["command"]), testing::HasSubstr("afterglow stress --repeat '"));
  EXPECT_THAT(read_file(place / "README.txt").value(),
              testing::HasSubstr("--path " + shell_word(folder.path().string()) + "\n"));
  EXPECT_EQ(read_file(place / "preset.lua").value(), kept.look.text());
}

TEST(StressReproducer, WhatIsNoneIsNamed) {
  const EffectFolder folder;
  Diagnostics quiet;
  const auto error = [&] { return read_reproducer(folder.path(), quiet).error().text(); };
  EXPECT_THAT(error(), testing::HasSubstr("case.json"));
  folder.write("case.json", "{");
  EXPECT_THAT(error(), testing::HasSubstr("is no case of `afterglow stress`"));
  folder.write("case.json",
               R"({"check": "finit", "stack": {"entries": [], "paths": []}, "frame": 1, "check_seed": 1})");
  EXPECT_THAT(error(), testing::HasSubstr("unknown check 'finit'"));
  EXPECT_THAT(error(), testing::HasSubstr("did you mean 'finite'?"));
  folder.write("case.json",
               R"({"check": "finite", "stack": {"entries": [], "paths": []}, "frame": 1, "check_seed": 1})");
  EXPECT_THAT(error(), testing::HasSubstr("input.exr"));
}

}  // namespace
}  // namespace afterglow::stress
