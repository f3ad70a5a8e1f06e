// SPDX-License-Identifier: MIT
// Settings by name: their schema, values in and out.
#include "fixture.h"

namespace afterglow::test {
namespace {

class SettingsTest : public ApiTest {
 protected:
  void SetUp() override {
    ApiTest::SetUp();
    stack_ = stack();
  }
  void TearDown() override {
    stack_.reset();
    ApiTest::TearDown();
  }
  float first_sample() {
    std::vector<float> source(4, 0.5f), result(4);
    afterglow_run_info info = afterglow_run_info_default();
    info.source = image(source, 1, 1);
    info.result = image(result, 1, 1);
    EXPECT_TRUE(fine(afterglow_stack_run(stack_.get(), &info)));
    return result[0];
  }
  StackPtr stack_;
};

TEST_F(SettingsTest, TheSchemaIsJson) {
  const auto entries = json_of(afterglow_stack_settings, stack_.get());
  ASSERT_EQ(entries.size(), 1u);
  EXPECT_EQ(entries[0]["name"], "gain");
  EXPECT_EQ(entries[0]["at"], "post_process");
  EXPECT_EQ(entries[0]["line"], 2);
  const auto& settings = entries[0]["settings"];
  ASSERT_EQ(settings.size(), 4u);
  const auto amount = *std::ranges::find(settings, "amount", [](const auto& s) { return s["name"]; });
  EXPECT_EQ(amount["type"], "float");
  EXPECT_EQ(amount["value"], 2);
  EXPECT_EQ(amount["default"], 1);
  EXPECT_EQ(amount["min"], 0);
  EXPECT_EQ(amount["max"], 1e6);
  EXPECT_EQ(amount["unit"], "times");
  EXPECT_EQ(amount["doc"], "Factor.");
  const auto way = *std::ranges::find(settings, "way", [](const auto& s) { return s["name"]; });
  EXPECT_EQ(way["choices"], (nlohmann::json{"once", "twice"}));
}

TEST_F(SettingsTest, TheSchemaHasHowAnEntryIsPutOverWhatItWasGiven) {
  look("fx.gain { opacity = 0.5, mask = fx.mask.luma { from = 0.25 } }");
  stack_ = stack();
  const auto entry = json_of(afterglow_stack_settings, stack_.get())[0];
  const auto of = [&](const char* name) {
    const auto& all = entry["composition"];
    const auto found = std::ranges::find(all, name, [](const auto& s) { return s["name"]; });
    return found == all.end() ? nlohmann::json() : nlohmann::json(*found);
  };
  EXPECT_EQ(of("opacity")["value"], 0.5);
  EXPECT_EQ(of("opacity")["max"], 1);
  EXPECT_EQ(of("blend")["value"], "normal");
  EXPECT_EQ(of("blend")["choices"].size(), 11u);
  EXPECT_EQ(of("mask")["value"], "luma");
  EXPECT_EQ(of("mask.luma.from")["value"], 0.25);
  EXPECT_FALSE(of("mask.luma.from")["doc"].empty());
  EXPECT_EQ(of("enabled"), nullptr);
  EXPECT_EQ(of("amount"), nullptr);
  // Every name of it can be set. A mask that is a number has no settings.
  for (const auto& setting : entry["composition"]) {
    if (setting["name"] == "mask") continue;
    const std::string name = "gain." + setting["name"].get<std::string>();
    const std::string value = setting["name"] == "blend" ? "add" : "0";
    EXPECT_TRUE(fine(afterglow_stack_set(stack_.get(), str(name.c_str()), str(value.c_str())))) << name;
  }
}

TEST_F(SettingsTest, EveryTypeGoesInAndOut) {
  EXPECT_FLOAT_EQ(first_sample(), 1.0f);
  ASSERT_TRUE(fine(afterglow_stack_set_number(stack_.get(), str("gain.amount"), 3)));
  double number = 0;
  ASSERT_TRUE(fine(afterglow_stack_get_number(stack_.get(), str("gain.amount"), &number)));
  EXPECT_EQ(number, 3);
  EXPECT_FLOAT_EQ(first_sample(), 1.5f);

  ASSERT_TRUE(fine(afterglow_stack_set_text(stack_.get(), str("gain.way"), str("twice"))));
  afterglow_text* text = nullptr;
  ASSERT_TRUE(fine(afterglow_stack_get_text(stack_.get(), str("gain.way"), &text)));
  EXPECT_EQ(str(afterglow_text_get(text)), "twice");
  afterglow_text_free(text);
  EXPECT_FLOAT_EQ(first_sample(), 4.5f);

  const double tint[] = {0.5, 0.25, 1};
  ASSERT_TRUE(fine(afterglow_stack_set_numbers(stack_.get(), str("gain.tint"), tint, 3)));
  double out[3] = {};
  size_t count = 0;
  ASSERT_TRUE(fine(afterglow_stack_get_numbers(stack_.get(), str("gain.tint"), out, 2, &count)));
  EXPECT_EQ(count, 3u);
  EXPECT_EQ(out[1], 0.25);
  EXPECT_EQ(out[2], 0);  // beyond the capacity
  EXPECT_FLOAT_EQ(first_sample(), 2.25f);

  ASSERT_TRUE(fine(afterglow_stack_set_boolean(stack_.get(), str("gain.off"), true)));
  bool off = false;
  ASSERT_TRUE(fine(afterglow_stack_get_boolean(stack_.get(), str("gain.off"), &off)));
  EXPECT_TRUE(off);
  EXPECT_FLOAT_EQ(first_sample(), 0.5f);

  ASSERT_TRUE(fine(afterglow_stack_unset(stack_.get(), str("gain.off"))));
  EXPECT_FLOAT_EQ(first_sample(), 2.25f);
  ASSERT_TRUE(fine(afterglow_stack_set(stack_.get(), str("gain.tint"), str("#ffffff"))));
  EXPECT_FLOAT_EQ(first_sample(), 4.5f);
  ASSERT_TRUE(fine(afterglow_stack_unset(stack_.get(), afterglow_str(nullptr))));
  EXPECT_FLOAT_EQ(first_sample(), 1.0f);
  ASSERT_TRUE(fine(afterglow_stack_set(stack_.get(), str("gain.enabled"), str("false"))));
  EXPECT_FLOAT_EQ(first_sample(), 0.5f);
  ASSERT_TRUE(fine(afterglow_stack_get_boolean(stack_.get(), str("gain.enabled"), &off)));
  EXPECT_FALSE(off);
}

TEST_F(SettingsTest, SeveralAreSetAtOnceAllOrNone) {
  for (const bool follow : {false, true}) {
    SCOPED_TRACE(follow);
    afterglow_stack_options options = listening();
    messages_.clear();
    options.follow = follow;
    stack_ = stack(options);
    const auto set = [&](const std::vector<afterglow_string>& names, const std::vector<afterglow_string>& values) {
      return ErrorPtr(afterglow_stack_set_several(stack_.get(), names.data(), values.data(), names.size()));
    };
    EXPECT_TRUE(fine(set({str("gain.amount"), str("gain.tint")}, {str("3"), str("{0.5, 1, 1}")}).release()));
    EXPECT_FLOAT_EQ(first_sample(), 0.75f);
    EXPECT_TRUE(fine(set({}, {}).release()));
    // One that does not fit, wherever it stands: nothing is set, not even what did before.
    for (const auto& [name, value] : {std::pair("gain.amonut", "1"), {"gain.way", "thrice"}, {"gain", "1"}}) {
      for (const bool first : {true, false}) {
        std::vector<afterglow_string> names{str("gain.amount"), str("gain.tint")}, values{str("9"), str("#ffffff")};
        names.insert(first ? names.begin() : names.end(), str(name));
        values.insert(first ? values.begin() : values.end(), str(value));
        EXPECT_EQ(afterglow_error_get_kind(set(names, values).get()), AFTERGLOW_ERROR_USAGE) << name << first;
        EXPECT_FLOAT_EQ(first_sample(), 0.75f);
      }
    }
    EXPECT_TRUE(fine(set({str("gain.amount"), str("gain.amount")}, {str("3"), str("4")}).release()));
    EXPECT_FLOAT_EQ(first_sample(), 1.0f) << "the later one";
    ASSERT_TRUE(fine(afterglow_stack_unset(stack_.get(), str("gain.amount"))));
    EXPECT_FLOAT_EQ(first_sample(), 0.5f);
    EXPECT_TRUE(messages_.empty()) << messages_.front();
    const ErrorPtr none(afterglow_stack_set_several(stack_.get(), nullptr, nullptr, 1));
    EXPECT_EQ(afterglow_error_get_kind(none.get()), AFTERGLOW_ERROR_USAGE);
  }
}

TEST_F(SettingsTest, AnEmptyNameIsNotAll) {
  ASSERT_TRUE(fine(afterglow_stack_set_number(stack_.get(), str("gain.amount"), 3)));
  const ErrorPtr error(afterglow_stack_unset(stack_.get(), str("")));
  EXPECT_EQ(afterglow_error_get_kind(error.get()), AFTERGLOW_ERROR_USAGE);
  EXPECT_FLOAT_EQ(first_sample(), 1.5f);
  ASSERT_TRUE(fine(afterglow_stack_unset(stack_.get(), str("gain.tint"))));  // which was not set
  EXPECT_FLOAT_EQ(first_sample(), 1.5f);
  ASSERT_TRUE(fine(afterglow_stack_unset(stack_.get(), afterglow_str(nullptr))));
  EXPECT_FLOAT_EQ(first_sample(), 1.0f);
}

TEST_F(SettingsTest, WhatEveryEntryHasGoesInAndOut) {
  const auto number = [&](const char* name) {
    double out = -1;
    EXPECT_TRUE(fine(afterglow_stack_get_number(stack_.get(), str(name), &out)));
    return out;
  };
  const auto text = [&](const char* name) {
    afterglow_text* out = nullptr;
    EXPECT_TRUE(fine(afterglow_stack_get_text(stack_.get(), str(name), &out)));
    const std::string copy = str(afterglow_text_get(out));
    afterglow_text_free(out);
    return copy;
  };
  EXPECT_EQ(number("gain.opacity"), 1);
  EXPECT_EQ(number("gain.order"), 10);
  EXPECT_EQ(number("gain.mask"), 1);
  EXPECT_EQ(text("gain.blend"), "normal");
  EXPECT_EQ(text("gain.at"), "post_process");
  ASSERT_TRUE(fine(afterglow_stack_set_number(stack_.get(), str("gain.opacity"), 0.5)));
  ASSERT_TRUE(fine(afterglow_stack_set_number(stack_.get(), str("gain.mask"), 0.25)));
  ASSERT_TRUE(fine(afterglow_stack_set_text(stack_.get(), str("gain.blend"), str("add"))));
  EXPECT_EQ(number("gain.opacity"), 0.5);
  EXPECT_EQ(number("gain.mask"), 0.25);
  EXPECT_EQ(text("gain.blend"), "add");

  look("fx.gain { amount = 2, mask = fx.mask.luma { from = 0.25 } }");
  stack_ = stack();
  EXPECT_EQ(number("gain.mask.luma.from"), 0.25);
  EXPECT_EQ(text("gain.mask"), "luma");
  ASSERT_TRUE(fine(afterglow_stack_set_number(stack_.get(), str("gain.mask.luma.from"), 0.5)));
  EXPECT_EQ(number("gain.mask.luma.from"), 0.5);
  double out = 0;
  const ErrorPtr mask(afterglow_stack_get_number(stack_.get(), str("gain.mask"), &out));
  EXPECT_THAT(text_of(mask.get()), HasSubstr("'gain.mask' is no number"));
  const ErrorPtr near(afterglow_stack_get_number(stack_.get(), str("gain.opactiy"), &out));
  EXPECT_EQ(str(afterglow_error_get_nearest(near.get())), "opacity");
}

TEST_F(SettingsTest, WhatIsNotAllowedIsRefusedAndChangesNothing) {
  ASSERT_TRUE(fine(afterglow_stack_set_number(stack_.get(), str("gain.amount"), 3)));
  const ErrorPtr name(afterglow_stack_set_number(stack_.get(), str("gain.amonut"), 1));
  EXPECT_EQ(afterglow_error_get_kind(name.get()), AFTERGLOW_ERROR_USAGE);
  EXPECT_EQ(str(afterglow_error_get_nearest(name.get())), "amount");
  EXPECT_THAT(text_of(name.get()), testing::StartsWith("error: gain.amonut: "));
  const ErrorPtr range(afterglow_stack_set_number(stack_.get(), str("gain.amount"), -1));
  EXPECT_EQ(afterglow_error_get_kind(range.get()), AFTERGLOW_ERROR_USAGE);
  EXPECT_FALSE(str(afterglow_error_get_allowed(range.get())).empty());
  const ErrorPtr infinite(afterglow_stack_set_number(stack_.get(), str("gain.amount"), 1.0 / 0.0));
  EXPECT_EQ(afterglow_error_get_kind(infinite.get()), AFTERGLOW_ERROR_USAGE);
  const ErrorPtr choice(afterglow_stack_set_text(stack_.get(), str("gain.way"), str("thrice")));
  EXPECT_THAT(str(afterglow_error_get_allowed(choice.get())), HasSubstr("twice"));
  double number = 0;
  const ErrorPtr type(afterglow_stack_get_number(stack_.get(), str("gain.way"), &number));
  EXPECT_THAT(text_of(type.get()), HasSubstr("'gain.way' is no number"));
  const ErrorPtr entry(afterglow_stack_get_number(stack_.get(), str("gian.amount"), &number));
  EXPECT_EQ(str(afterglow_error_get_nearest(entry.get())), "gain");
  EXPECT_FLOAT_EQ(first_sample(), 1.5f);
}

TEST_F(SettingsTest, ExplanationsTellWhereValuesComeFrom) {
  ASSERT_TRUE(fine(afterglow_stack_set_number(stack_.get(), str("gain.amount"), 3)));
  first_sample();
  const auto told = json_of(afterglow_stack_explain, stack_.get());
  EXPECT_EQ(told["inputs"], nlohmann::json::array());
  EXPECT_EQ(told["pre_roll"], 0);
  const auto& gain = told["entries"][0];
  EXPECT_EQ(gain["state"], "runs");
  const auto amount = *std::ranges::find(gain["settings"], "amount", [](const auto& s) { return s["name"]; });
  EXPECT_EQ(amount["default"], 1);
  EXPECT_EQ(amount["preset"]["value"], 2);
  EXPECT_EQ(amount["override"], 3);
  EXPECT_EQ(amount["final"], 3);

  const auto report = json_of(afterglow_stack_report, stack_.get());
  EXPECT_EQ(report["kernels"], nlohmann::json{"gain.gain"});
  EXPECT_GT(report["milliseconds"]["script"], 0);
}

/// What a renderer has to make for it.
TEST_F(SettingsTest, ExplanationsTellWhatALookAsksFor) {
  write("look.lua",
        "local fx = require 'afterglow'\nreturn fx.stack { fx.auto_exposure { }, fx.gain { mask = fx.mask.depth { } } "
        "}\n");
  ASSERT_TRUE(fine(afterglow_stack_reload(stack_.get(), {})));
  EXPECT_EQ(json_of(afterglow_stack_explain, stack_.get())["inputs"], nlohmann::json{"depth"});
  first_sample();
  EXPECT_EQ(json_of(afterglow_stack_explain, stack_.get())["pre_roll"], 121);
}

TEST_F(SettingsTest, ArgumentsOfThePresetAreGiven) {
  const auto gain_of = [](const char* type) {
    return std::string("local fx = require 'afterglow'\nlocal args = fx.args { strength = ") + type +
           ", label = fx.enum { 'a', 'b', default = 'a', doc = 'Which.' } }\nreturn fx.stack { fx.gain { amount = "
           "args.strength } }\n";
  };
  for (const bool follow : {false, true}) {
    write("look.lua", gain_of("fx.float { default = 2, min = 0, max = 9, doc = 'How much.' }"));
    afterglow_stack_options options = listening();
    messages_.clear();
    options.follow = follow;
    const afterglow_string arguments[] = {afterglow_str("strength=4"), afterglow_str("label=b")};
    options.arguments = arguments;
    options.argument_count = 2;
    stack_ = stack(options);
    EXPECT_FLOAT_EQ(first_sample(), 2.0f);
    const auto told = json_of(afterglow_stack_arguments, stack_.get());
    ASSERT_EQ(told.size(), 2u);
    const auto& one = told[told[0]["name"] == "strength" ? 0 : 1];
    EXPECT_EQ(one["value"], 4);
    EXPECT_EQ(one["default"], 2);
    EXPECT_EQ(one["max"], 9);
    EXPECT_EQ(one["given"], true);

    ASSERT_TRUE(fine(afterglow_stack_set_argument(stack_.get(), str("strength"), str("6"))));
    EXPECT_FLOAT_EQ(first_sample(), 3.0f);
    ASSERT_TRUE(fine(afterglow_stack_set_number(stack_.get(), str("gain.amount"), 1)));
    EXPECT_FLOAT_EQ(first_sample(), 0.5f) << "what was set stands above";
    ASSERT_TRUE(fine(afterglow_stack_unset(stack_.get(), str("gain.amount"))));
    const ErrorPtr name(afterglow_stack_set_argument(stack_.get(), str("strenght"), str("6")));
    EXPECT_EQ(afterglow_error_get_kind(name.get()), AFTERGLOW_ERROR_USAGE);
    EXPECT_EQ(str(afterglow_error_get_nearest(name.get())), "strength");
    EXPECT_THAT(text_of(name.get()), testing::StartsWith("error: argument strenght: "));
    const ErrorPtr range(afterglow_stack_set_argument(stack_.get(), str("strength"), str("10")));
    EXPECT_EQ(afterglow_error_get_kind(range.get()), AFTERGLOW_ERROR_USAGE);
    for (const char* wrong : {"", "a=b", "a b"})
      EXPECT_EQ(
          afterglow_error_get_kind(ErrorPtr(afterglow_stack_set_argument(stack_.get(), str(wrong), str("1"))).get()),
          AFTERGLOW_ERROR_USAGE);
    EXPECT_FLOAT_EQ(first_sample(), 3.0f);

    // What the preset comes not to know is left out; the rest stays.
    write("look.lua", gain_of("fx.float { default = 2, min = 0, max = 5, doc = 'How much.' }"));
    ASSERT_TRUE(fine(afterglow_stack_reload(stack_.get(), afterglow_str(nullptr))));
    EXPECT_FLOAT_EQ(first_sample(), 1.0f);
    EXPECT_THAT(messages_, testing::ElementsAre(testing::StartsWith("argument strength")));
    ASSERT_TRUE(fine(afterglow_stack_set_argument(stack_.get(), str("label"), str("a"))));
    ASSERT_TRUE(fine(afterglow_stack_set_argument(stack_.get(), str("strength"), str("5"))));
    EXPECT_FLOAT_EQ(first_sample(), 2.5f);
    ASSERT_TRUE(fine(afterglow_stack_set_argument(stack_.get(), str("strength"), afterglow_str(nullptr))));
    EXPECT_FLOAT_EQ(first_sample(), 1.0f);

    options.argument_count = 1;
    for (const char* wrong : {"strength", "strength=much", "strenght=1"}) {
      const afterglow_string argument = afterglow_str(wrong);
      options.arguments = &argument;
      EXPECT_EQ(afterglow_error_get_kind(broken(options).get()), AFTERGLOW_ERROR_USAGE) << wrong;
    }
    options.arguments = nullptr;
    EXPECT_EQ(afterglow_error_get_kind(broken(options).get()), AFTERGLOW_ERROR_USAGE);
  }
}

}  // namespace
}  // namespace afterglow::test
