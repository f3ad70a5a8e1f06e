// SPDX-License-Identifier: MIT
// What effects promise: read, checked, and asked for the settings of a frame.
#include <gmock/gmock.h>

#include <cmath>

#include "scene.h"
#include "script/schema.h"

namespace afterglow::test {
namespace {

constexpr const char* kRest =
    "\n  settings = { amount = fx.float { min = 0, max = 2, default = 1 }, mode = fx.enum { \"a\", default = \"a\" } },"
    "\n  build = function(g, s, source) return source end,";

std::string declared(const std::string& holds) {
  Scene scene;
  scene.effect("glow", "  holds = {\n    " + holds + "\n  }," + kRest);
  scene.stack("fx.glow {}");
  return scene.load_error();
}

std::vector<Invariant> held(const std::string& holds, const std::string& entry = "fx.glow {}", Size size = {64, 32}) {
  Scene scene;
  scene.effect("glow", "  holds = { " + holds + " }," + kRest);
  scene.stack(entry);
  auto preset = scene.load();
  EXPECT_TRUE(preset) << preset.error().text();
  scene.context.size = size;
  const auto build = scene.evaluate(*preset);
  EXPECT_TRUE(build) << build.error().text();
  if (!build) return {};
  EXPECT_FALSE(build->promise_error) << build->promise_error->text();
  EXPECT_EQ(build->promises.at(0).entry, "glow");
  return build->promises.at(0).invariants;
}

TEST(Holds, NamesNumbersAndTables) {
  const auto holds = held(
      "\"black\", mean = 1e-3, shift = { by = 4, margin = 9 }, proportional = { setting = \"amount\", up_to = 2 }");
  ASSERT_EQ(holds.size(), 4u);
  EXPECT_EQ(holds[0].name, "black");
  EXPECT_EQ(holds[0].numbers.at("within"), 0);
  EXPECT_EQ(holds[1].name, "mean");
  EXPECT_EQ(holds[1].numbers.at("within"), 1e-3);
  EXPECT_EQ(holds[2].settings.at("setting"), "amount");
  EXPECT_EQ(holds[3].numbers.at("by"), 4);
  EXPECT_EQ(holds[3].numbers.at("margin"), 9);
  EXPECT_EQ(holds[3].numbers.at("within"), 1e-5);
}

TEST(Holds, FunctionsOfSettingsAndSize) {
  const std::string text =
      "continuous = function(s, source) return s.amount * source.width end, "
      "mirror = { when = function(s, source) return s.amount > 1 and source.height == 32 end }";
  auto holds = held(text, "fx.glow { amount = 0.5 }");
  ASSERT_EQ(holds.size(), 1u);
  EXPECT_EQ(holds[0].numbers.at("slope"), 32);
  EXPECT_EQ(held(text, "fx.glow { amount = 1.5 }").size(), 2u);
  EXPECT_EQ(held(text, "fx.glow { amount = 1.5 }", {64, 33}).size(), 1u);
}

TEST(Holds, FalseIsNoBound) {
  const auto holds = held("error = { fp32 = 1e-4, fp16 = false }");
  ASSERT_EQ(holds.size(), 1u);
  EXPECT_EQ(holds[0].numbers.at("fp32"), 1e-4);
  EXPECT_TRUE(std::isinf(holds[0].numbers.at("fp16")));
}

TEST(Holds, Messages) {
  EXPECT_EQ(declared("\"blak\""),
            "effects/glow.lua:4: error: fx.effect: holds: unknown promise \"blak\"; allowed: black, constant, mean, "
            "no_added_light, "
            "monotone, bounded, continuous, linear, proportional, mirror, turn_180, turn_90, shift, error; did you "
            "mean 'black'?");
  EXPECT_EQ(declared("meen = 1"),
            "effects/glow.lua:4: error: fx.effect: holds: unknown promise 'meen'; allowed: black, constant, mean, "
            "no_added_light, "
            "monotone, bounded, continuous, linear, proportional, mirror, turn_180, turn_90, shift, error; did you "
            "mean 'mean'?");
  EXPECT_EQ(declared("mirror = {\n      wihin = 3 }"),
            "effects/glow.lua:5: error: fx.effect: holds: mirror has no 'wihin'; allowed: when, within; did you mean "
            "'within'?");
  EXPECT_EQ(declared("mirror = { when = true }"),
            "effects/glow.lua:4: error: fx.effect: holds: mirror: when = true; allowed: a function");
  EXPECT_EQ(
      declared("mirror = \"yes\""),
      "effects/glow.lua:4: error: fx.effect: holds: mirror: within = \"yes\"; allowed: a number, function(s, source)");
  EXPECT_EQ(declared("mean = {}"), "effects/glow.lua:4: error: fx.effect: holds: mean needs within");
  EXPECT_EQ(declared("\"continuous\""), "effects/glow.lua:4: error: fx.effect: holds: continuous needs slope");
  EXPECT_EQ(declared("proportional = { setting = \"amout\", up_to = 1 }"),
            "effects/glow.lua:4: error: fx.effect: holds: proportional: setting = \"amout\" is no setting that is a "
            "number; allowed: "
            "amount; did you mean 'amount'?");
  EXPECT_EQ(
      declared("3"),
      "effects/glow.lua:4: error: fx.effect: holds: unknown promise 3; allowed: black, constant, mean, no_added_light, "
      "monotone, bounded, continuous, linear, proportional, mirror, turn_180, turn_90, shift, error");
}

TEST(Holds, FunctionsThatFail) {
  Scene scene;
  scene.effect("glow", std::string("  holds = { continuous = function(s) return \"much\" end,\n   black = { when = "
                                   "function() return 3 end } },") +
                           kRest);
  scene.stack("fx.glow {}");
  auto preset = scene.load();
  ASSERT_TRUE(preset);
  const auto build = scene.evaluate(*preset);
  ASSERT_TRUE(build) << "the frame is none the worse for it";
  ASSERT_TRUE(build->promise_error);
  EXPECT_EQ(scene.shorten(build->promise_error->text()),
            "effects/glow.lua:4: error: when of holds of effect 'glow' returned 3, not true or false");
}

TEST(Holds, AreToldInWords) {
  Scene scene;
  scene.effect("glow", std::string("  holds = { \"black\", mean = { within = 0.5, when = function() return true end }, "
                                   "continuous = function() return 1 end },") +
                           kRest);
  scene.stack("fx.glow {}");
  auto preset = scene.load();
  ASSERT_TRUE(preset);
  std::vector<std::string> texts;
  for (const auto& hold : preset->schema("glow").invariants) texts.push_back(invariant_text(hold));
  EXPECT_THAT(texts, testing::ElementsAre("black (within 0)", "continuous (slope by settings)",
                                          "mean (margin 0; within 0.5; for some settings)"));
}

}  // namespace
}  // namespace afterglow::test
