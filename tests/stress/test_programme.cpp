// SPDX-License-Identifier: MIT
// The programme as a whole: what it tries, what it finds, how it ends.
#include <nlohmann/json.hpp>

#include "bad_effects.h"
#include "stress/growth.h"
#include "stress/report.h"

namespace afterglow::stress {
namespace {

constexpr const char* kBroken =
    "vec4 apply(vec4 color) { return strength > 0.99 && color.g > 3.0 ? vec4(1.0 / vec3(color.r - color.r), color.a) : "
    "vec4(color.rgb * level, color.a); }";

Trials trials_of(const EffectFolder& folder, const std::vector<std::string>& effects, std::uint64_t seed) {
  harness();
  Diagnostics quiet;
  auto subjects = subjects_of_effects(effects, {folder.path()}, quiet);
  EXPECT_TRUE(subjects);
  return Trials(std::move(*subjects), search_path_for({}, {folder.path()}), seed);
}

Result<void> go_on(const Summary&) { return {}; }

TEST(StressProgramme, TrialsAreMadeFromSeedAndNumberAlone) {
  const EffectFolder folder;
  folder.effect("good", "vec4 apply(vec4 color) { return color * (strength + level); }");
  const Trials a = trials_of(folder, {"good"}, 5), b = trials_of(folder, {"good"}, 5),
               c = trials_of(folder, {"good"}, 6);
  int different = 0;
  for (const std::uint64_t index : {0u, 3u, 50u, 1000u}) {
    const Trial x = a.at(index), y = b.at(index);
    EXPECT_EQ(x.look.text(), y.look.text());
    EXPECT_EQ(x.size, y.size);
    EXPECT_EQ(x.seed, y.seed);
    ASSERT_EQ(x.pictures.size(), y.pictures.size());
    for (std::size_t i = 0; i < x.pictures.size(); ++i) EXPECT_EQ(x.pictures[i].seed, y.pictures[i].seed);
    different += x.seed != c.at(index).seed;
  }
  EXPECT_EQ(different, 4);
  EXPECT_EQ(a.at(0).look.line(), "fx.good {}");
}

TEST(StressProgramme, AMaskIsTriedInCompositionsWithItAlone) {
  const EffectFolder folder;
  folder.write("masks/half.lua", R"(local fx = require "afterglow"
return fx.effect { name = "half", doc = "Made for a test.", settings = {},
  build = function(g, s, source) return g:pass { shader = "half/half", source = source } end })");
  folder.write("shaders/half/half.glsl", "vec4 apply(vec4 c) { return vec4(0.5); }\n");
  const Trials trials = trials_of(folder, {"mask.half"}, 5);
  int masked = 0;
  for (std::uint64_t index = 1; index < 40; ++index) {
    const std::string line = trials.at(index).look.line();
    masked += line.find("fx.mask.half") != std::string::npos;
    EXPECT_EQ(line.find("fx.mask.luma"), std::string::npos) << line;
  }
  EXPECT_GT(masked, 10);
}

TEST(StressProgramme, AnEffectThatCannotBeReadIsTheError) {
  const EffectFolder folder;
  folder.effect("bad", "vec4 apply(vec4 color) { return color; }", "holds = { \"blakc\" },");
  harness();
  Diagnostics quiet;
  const auto subjects = subjects_of_effects({"bad"}, {folder.path()}, quiet);
  ASSERT_FALSE(subjects);
  EXPECT_EQ(subjects.error().kind, ErrorKind::script);
  EXPECT_NE(subjects.error().text().find("unknown promise \"blakc\""), std::string::npos) << subjects.error().text();
  const auto unknown = subjects_of_effects({"blom"}, {folder.path()}, quiet);
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().nearest, "bloom");
}

TEST(StressProgramme, APromiseWithoutAnOracleIsTold) {
  const EffectFolder folder;
  folder.effect("own", "vec4 apply(vec4 color) { return color * level; }", "holds = { error = { fp16 = 1e-9 } },");
  harness();
  std::string said;
  Diagnostics heard([&](Severity, const std::string& text) { said += text; });
  ASSERT_TRUE(subjects_of_effects({"own"}, {folder.path()}, heard));
  EXPECT_NE(said.find("effect 'own' promises an error"), std::string::npos) << said;
  said.clear();
  ASSERT_TRUE(subjects_of_effects({"vignette", "burn_in", "lens_dirt"}, {folder.path()}, heard));
  EXPECT_EQ(said, "");
}

TEST(StressProgramme, FindsShrinksAndKeepsAFault) {
  const EffectFolder folder;
  folder.effect("broken", kBroken);
  const Trials trials = trials_of(folder, {"broken"}, 3);
  ProgrammeOptions options{.seed = 3, .cases = 400, .out = folder.path() / "found"};
  Diagnostics quiet;
  int reported = 0;
  const auto summary = run_programme(harness(), trials, options, quiet, go_on, [&](const Finding&) { ++reported; });
  ASSERT_TRUE(summary) << summary.error().text();
  EXPECT_GE(summary->cases, 400u);
  EXPECT_GT(summary->failures, 0u);
  ASSERT_FALSE(summary->findings.empty());
  EXPECT_EQ(reported, static_cast<int>(summary->findings.size()));
  const Finding& first = summary->findings.front();
  EXPECT_EQ(first.subject, "broken");
  EXPECT_EQ(first.check, "finite");
  EXPECT_THAT(first.stack, testing::HasSubstr("{ strength = "));
  EXPECT_LE(first.size.area(), 2);
  const auto again = read_reproducer(first.folder, quiet);
  ASSERT_TRUE(again) << again.error().text();
  EXPECT_FALSE(outcome_of(*again).holds);
  // Mended, the same case holds.
  folder.write("shaders/broken/broken.glsl",
               "uniform float strength;\nuniform float level;\nvec4 apply(vec4 color) { return vec4(color.rgb * level "
               "* (0.5 + 0.5 * strength), color.a); }\n");
  EXPECT_TRUE(outcome_of(*again).holds);
}

TEST(StressProgramme, KnowsWhatWasNeverActive) {
  const EffectFolder folder;
  const std::string active = "active = function(s) return s.level > 20, \"level is small\" end,";
  folder.effect("asleep", "vec4 apply(vec4 color) { return color / (color - color) * (strength + level); }", active);
  folder.effect("good", "vec4 apply(vec4 color) { return vec4(color.rgb * strength, color.a); }");
  const Trials trials = trials_of(folder, {"asleep", "good"}, 1);
  Diagnostics quiet;
  const auto summary = run_programme(harness(), trials, {.seed = 1, .cases = 40}, quiet, go_on, [](const Finding&) {});
  ASSERT_TRUE(summary) << summary.error().text();
  EXPECT_EQ(summary->failures, 0u);
  const auto never = never_active(*summary, [](const std::string&) { return 1; });
  ASSERT_EQ(never.size(), 1u);
  EXPECT_EQ(never.front().subject, "asleep");
  EXPECT_EQ((NeverActive{"asleep", 2, never.front().reason}.text()),
            "asleep was never active in 2 trials: level is small");
  EXPECT_TRUE(never_active(*summary, [](const std::string&) { return 10000; }).empty());
  StressReport report{.summary = *summary};
  EXPECT_TRUE(report.clean());
  report.never_active = never;
  EXPECT_FALSE(report.clean());
  EXPECT_THAT(report_text(report), testing::HasSubstr("\nasleep was never active in "));
}

TEST(StressProgramme, EndsInOrderWhenInterrupted) {
  const EffectFolder folder;
  folder.effect("good", "vec4 apply(vec4 color) { return color * (strength + level); }");
  const Trials trials = trials_of(folder, {"good"}, 1);
  Diagnostics quiet;
  const auto summary = run_programme(
      harness(), trials, {.seed = 1}, quiet,
      [](const Summary& so_far) -> Result<void> {
        return so_far.trials < 2 ? Result<void>() : Result<void>(Error{ErrorKind::interrupted, "now"});
      },
      [](const Finding&) {});
  ASSERT_TRUE(summary);
  EXPECT_TRUE(summary->interrupted);
  EXPECT_EQ(summary->trials, 2u);
  EXPECT_GT(summary->cases, 0u);
}

TEST(StressProgramme, ABrokenDefaultIsAnError) {
  const EffectFolder folder;
  folder.effect("refuses", "vec4 apply(vec4 color) { return color * strength * level; }",
                "active = function() error(\"never\", 0) end,");
  const Trials trials = trials_of(folder, {"refuses"}, 1);
  Diagnostics quiet;
  const auto summary = run_programme(harness(), trials, {.seed = 1}, quiet, go_on, [](const Finding&) {});
  ASSERT_FALSE(summary);
  EXPECT_THAT(summary.error().text(), testing::HasSubstr("never"));
}

TEST(StressProgramme, OtherProcessesAreCompared) {
  const std::map<std::uint64_t, Hash> own{{3, {1, 2}}, {8, {3, 4}}};
  const auto same = compare_digests("x", own, digests_text(own));
  ASSERT_TRUE(same);
  EXPECT_EQ(same->compared, 2u);
  EXPECT_TRUE(same->different.empty());
  const auto other = compare_digests("x", own, digests_text({{3, {1, 2}}, {8, {3, 5}}}));
  ASSERT_TRUE(other);
  EXPECT_THAT(other->different, testing::ElementsAre(8));
  EXPECT_FALSE(compare_digests("x", own, "3 zz\n8"));
  EXPECT_FALSE(compare_digests("x", own, digests_text({{3, {1, 2}}})));
  StressReport report;
  report.processes = {*other};
  EXPECT_FALSE(report.clean());
}

TEST(StressProgramme, ReportsErrorsLevelByLevel) {
  harness();
  Diagnostics quiet;
  auto subjects = subjects_of_effects({"bloom", "vignette"}, {}, quiet);
  ASSERT_TRUE(subjects);
  const auto rows = error_growth(harness(), *subjects, {64, 64}, true, 1, [] { return Result<void>(); });
  ASSERT_TRUE(rows) << rows.error().text();
  std::set<int> levels;
  for (const auto& row : *rows) {
    EXPECT_EQ(row.effect, "bloom");
    EXPECT_GT(row.fp32.worst, 0);
    EXPECT_LT(row.fp32.percentile, 1e-5);
    if (row.has_fp16) {
      EXPECT_GT(row.fp16.percentile, row.fp32.percentile);
    }
    levels.insert(row.levels);
  }
  EXPECT_THAT(levels, testing::ElementsAre(1, 2, 3, 4));  // 16, 8, 4, 2 pixels
  StressReport report;
  report.growth = *rows;
  report.summary.checks["finite"].add({});
  const auto json = nlohmann::json::parse(report_json(report));
  EXPECT_EQ(json["error_growth"].size(), rows->size());
  EXPECT_EQ(json["checks"]["finite"]["cases"], 1);
  EXPECT_THAT(report_text(report), testing::HasSubstr("bloom"));
}

}  // namespace
}  // namespace afterglow::stress
