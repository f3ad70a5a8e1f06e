// SPDX-License-Identifier: MIT
// Settings that go back into the text of a preset: what stays, what is refused, what lands in the file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <atomic>
#include <fstream>
#include <future>
#include <thread>

#include "core/file.h"
#include "edit/write_back.h"
#include "scene.h"
#include "script/explanation.h"

namespace afterglow::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

SettingValue number(double value) { return {SettingType::number, {value}, ""}; }
SettingValue whole(double value) { return {SettingType::integer, {value}, ""}; }
SettingValue boolean(bool value) { return {SettingType::boolean, {value ? 1.0 : 0.0}, ""}; }
SettingValue choice(const std::string& value) { return {SettingType::enumeration, {}, value}; }
SettingValue color(double r, double g, double b) { return {SettingType::color, {r, g, b}, ""}; }
SettingValue vec2(double x, double y) { return {SettingType::vec2, {x, y}, ""}; }

class WriteBack : public ::testing::Test {
 protected:
  WriteBack() {
    scene.effect("glow", R"(at = "post_process",
  settings = { amount = fx.float { default = 0.5, min = -10, max = 1e6 }, knee = fx.float { default = 0.25, min = 0, max = 1 },
    steps = fx.int { default = 4, min = 0, max = 255 }, soft = fx.bool { default = true },
    mode = fx.enum { "plain", "fancy", default = "plain" }, tint = fx.color { default = { 1, 1, 1 } },
    offset = fx.vec2 { default = { 0, 0 } } },
  build = function(g, s, source) return source end)");
  }

  std::string file() const { return (scene.folder() / "preset.lua").string(); }

  Result<Rewrite> rewrite(const std::string& text, const std::vector<PresetEdit>& edits) {
    return rewrite_preset(scene.folder() / "preset.lua", text, edits, scene.options);
  }
  /// The text with the edits, all of which must be made; else the reason.
  std::string edited(const std::string& text, const std::vector<PresetEdit>& edits) {
    const auto out = rewrite(text, edits);
    if (!out) return scene.shorten(out.error().text());
    if (!out->refused.empty()) return scene.shorten(out->refused[0].reason.text());
    return out->text;
  }
  /// The same for what stands inside a stack.
  std::string inside(const std::string& entries, const std::vector<PresetEdit>& edits) {
    const std::string text = edited(head + entries + tail, edits);
    if (!text.starts_with(head) || !text.ends_with(tail)) return text;
    return text.substr(head.size(), text.size() - head.size() - tail.size());
  }
  std::string refusal(const std::string& text, const std::vector<PresetEdit>& edits) {
    const auto out = rewrite(text, edits);
    if (!out) return "failed: " + scene.shorten(out.error().text());
    EXPECT_EQ(out->text, text);
    return out->refused.empty() ? "" : scene.shorten(out->refused[0].reason.text());
  }

  const std::string head = "local fx = require \"afterglow\"\nreturn fx.stack {\n", tail = "\n}\n";
  Scene scene;
};

TEST_F(WriteBack, NumbersKeepTheirStyle) {
  const auto to = [&](const std::string& old, double value) {
    const std::string out = inside("fx.glow { amount = " + old + " }", {{"glow", "amount", number(value)}});
    return out.substr(19, out.size() - 21);
  };
  EXPECT_EQ(to("0.2", 0.4), "0.4");
  EXPECT_EQ(to("1.0", 2), "2.0");
  EXPECT_EQ(to("0.50", 0.7), "0.70");
  EXPECT_EQ(to("0.25", 3), "3");
  EXPECT_EQ(to(".5", 0.75), ".75");
  EXPECT_EQ(to("- 1", 2), "2");
  EXPECT_EQ(to("3", -2.5), "-2.5");
  EXPECT_EQ(to("1e3", 2500), "2.5e3");
  EXPECT_EQ(to("5E-4", 0.00025), "2.5E-4");
  EXPECT_EQ(to("1e3", 0.5), "0.5");
  EXPECT_EQ(to("1.50e-10", 0.25), "0.25");
  EXPECT_EQ(to("0xFF", 171), "0xAB");
  EXPECT_EQ(to("0x10", 0.5), "0.5");
  EXPECT_EQ(to("0x1p-1", 0.3), "0.3");
  EXPECT_EQ(to("0.5", 0.1f), "0.1");                       // came from a 32-bit float
  EXPECT_EQ(to("0.5", 0.123456789012), "0.123456789012");  // did not
}

TEST_F(WriteBack, EveryTypeInItsOwnNotation) {
  EXPECT_EQ(inside("fx.glow { mode = 'plain', soft = true, steps = 0x04 }",
                   {{"glow", "mode", choice("fancy")}, {"glow", "soft", boolean(false)}, {"glow", "steps", whole(11)}}),
            "fx.glow { mode = 'fancy', soft = false, steps = 0x0b }");
  EXPECT_EQ(inside("fx.glow { mode = [==[plain]==] }", {{"glow", "mode", choice("fancy")}}),
            "fx.glow { mode = [==[fancy]==] }");
  EXPECT_EQ(inside("fx.glow { offset={ 1.0,\n  -2 -- down\n } }", {{"glow", "offset", vec2(3, 4)}}),
            "fx.glow { offset={ 3.0,\n  4 -- down\n } }");
  EXPECT_EQ(inside("fx.glow { tint = {1,1,1} }", {{"glow", "tint", color(0.5, 2, 0)}}), "fx.glow { tint = {0.5,2,0} }");
}

TEST_F(WriteBack, ColoursStayHexWhereTheyCan) {
  // #80 is 0.21586… in linear light (IEC 61966-2-1).
  const double half = std::pow((128 / 255.0 + 0.055) / 1.055, 2.4);
  EXPECT_EQ(inside("fx.glow { tint = \"#ffffff\" }", {{"glow", "tint", color(half, 0, 1)}}),
            "fx.glow { tint = \"#8000ff\" }");
  EXPECT_EQ(inside("fx.glow { tint = '#FFEEDD' }", {{"glow", "tint", color(static_cast<float>(half), 0, 1)}}),
            "fx.glow { tint = '#8000FF' }");
  EXPECT_EQ(inside("fx.glow { tint = \"#ffffff\" }", {{"glow", "tint", color(2, 0.5, 1)}}),
            "fx.glow { tint = { 2, 0.5, 1 } }");
  // Over numbers, where it would be many digits.
  EXPECT_EQ(inside("fx.glow { tint = { 0, 0, 0 } }", {{"glow", "tint", color(half, 0, 1)}}),
            "fx.glow { tint = \"#8000ff\" }");
  EXPECT_EQ(inside("fx.glow { tint = { 0.5, 0, 0 } }", {{"glow", "tint", color(1, 0, 1)}}),
            "fx.glow { tint = { 1, 0, 1 } }");
  // And where none stood, in the quotes of the script.
  EXPECT_EQ(inside("fx.glow {}", {{"glow", "tint", color(half, 0, 1)}}), "fx.glow { tint = \"#8000ff\" }");
  EXPECT_EQ(inside("fx.glow { mode = 'plain' }", {{"glow", "tint", color(half, 0, 1)}}),
            "fx.glow { mode = 'plain', tint = '#8000ff' }");
}

TEST_F(WriteBack, NewSettingsFollowTheirNeighbours) {
  const PresetEdit knee{"glow", "knee", number(0.75)}, steps{"glow", "steps", whole(7)};
  const auto one = [&](const std::string& entries) { return inside(entries, {knee}); };
  EXPECT_EQ(one("fx.glow {}"), "fx.glow { knee = 0.75 }");
  EXPECT_EQ(one("fx.glow { }"), "fx.glow { knee = 0.75 }");
  EXPECT_EQ(one("fx.glow({})"), "fx.glow({ knee = 0.75 })");
  EXPECT_EQ(one("fx.glow { amount = 1 },"), "fx.glow { amount = 1, knee = 0.75 },");
  EXPECT_EQ(one("fx.glow {amount=1,steps=2}"), "fx.glow {amount=1,steps=2,knee=0.75}");
  EXPECT_EQ(one("fx.glow { amount = 1; steps = 2; }"), "fx.glow { amount = 1; steps = 2; knee = 0.75; }");
  EXPECT_EQ(one("fx.glow { ['amount'] = 1 }"), "fx.glow { ['amount'] = 1, ['knee'] = 0.75 }");
  EXPECT_EQ(one("fx.glow {\n  amount = 1, -- much\n}"), "fx.glow {\n  amount = 1, -- much\n  knee = 0.75,\n}");
  EXPECT_EQ(one("fx.glow {\n\tamount = 1,\n\tsteps = 2 -- few\n\t}"),
            "fx.glow {\n\tamount = 1,\n\tsteps = 2, -- few\n\tknee = 0.75\n\t}");
  EXPECT_EQ(one("fx.glow {\n  amount = 1 --[[ a\n comment ]] --[==[ another\n]==]\n}"),
            "fx.glow {\n  amount = 1, --[[ a\n comment ]] --[==[ another\n]==]\n  knee = 0.75\n}");
  EXPECT_EQ(one("fx.glow { amount = 1,\n          steps = 2 }"),
            "fx.glow { amount = 1,\n          steps = 2,\n          knee = 0.75 }");
  EXPECT_EQ(one("fx.glow { amount = 1, steps = 2,\n          soft = true, mode = \"plain\" }"),
            "fx.glow { amount = 1, steps = 2,\n          soft = true, mode = \"plain\", knee = 0.75 }");
  EXPECT_EQ(one("fx.glow {\n  amount   = 1,\n  steps    = 2,\n}"),
            "fx.glow {\n  amount   = 1,\n  steps    = 2,\n  knee     = 0.75,\n}");
  EXPECT_EQ(one("fx.glow {\n  -- nothing yet\n}"), "fx.glow {\n  knee = 0.75,\n  -- nothing yet\n}");
  EXPECT_EQ(inside("fx.glow {}", {knee, steps}), "fx.glow { knee = 0.75, steps = 7 }");
  EXPECT_EQ(inside("fx.glow {}", {{"glow", "mode", choice("fancy")}, {"glow", "tint", color(1, 2, 3)}}),
            "fx.glow { mode = \"fancy\", tint = { 1, 2, 3 } }");
}

TEST_F(WriteBack, LongTablesAreBroken) {
  std::string line = "fx.glow { amount = 123456.789, steps = 123, --" + std::string(60, '-') +
                     "\n          soft = false, mode = " + std::string(60, ' ') + "\"fancy\" }";
  EXPECT_EQ(inside(line, {{"glow", "offset", vec2(0.125, 0.5)}}),
            line.substr(0, line.size() - 2) + ",\n          offset = { 0.125, 0.5 } }");
}

TEST_F(WriteBack, LineEndsAndMarksStay) {
  const std::string text =
      "\xEF\xBB\xBFlocal fx = require \"afterglow\"\r\nreturn fx.stack {\r\n  fx.glow {\r\n    amount = 1,\r\n  "
      "},\r\n}\r\n";
  EXPECT_EQ(edited(text, {{"glow", "amount", number(2)}, {"glow", "steps", whole(5)}}),
            "\xEF\xBB\xBFlocal fx = require \"afterglow\"\r\nreturn fx.stack {\r\n  fx.glow {\r\n    amount = 2,\r\n   "
            " steps = 5,\r\n  },\r\n}\r\n");
  EXPECT_EQ(edited("local fx = require \"afterglow\"\rreturn fx.stack {\rfx.glow { amount = 1 } }",
                   {{"glow", "amount", number(2)}}),
            "local fx = require \"afterglow\"\rreturn fx.stack {\rfx.glow { amount = 2 } }");
}

TEST_F(WriteBack, WhateverWayTheCallIsWritten) {
  const PresetEdit edit{"glow", "amount", number(2)};
  for (const char* call : {"fx.glow{amount=1}", "fx.glow ({amount=1})", "fx['glow']{amount=1}", "fx\n.glow\n{amount=1}",
                           "fx.glow -- c {\n  {amount=1}", "(fx.glow){amount=1}", "fx.glow{amount=3,amount=1}"}) {
    std::string wanted = call;
    wanted.replace(wanted.rfind("amount=1"), 8, "amount=2");
    EXPECT_EQ(inside(call, {edit}), wanted) << call;
  }
  EXPECT_EQ(edited("local make = require \"afterglow\".glow\nlocal mine = make { amount = 1 }\nreturn require "
                   "\"afterglow\".stack { mine }",
                   {edit}),
            "local make = require \"afterglow\".glow\nlocal mine = make { amount = 2 }\nreturn require "
            "\"afterglow\".stack { mine }");
}

TEST_F(WriteBack, EntriesOnOneLineAreToldApart) {
  const std::string two = "fx.glow { amount = 1 }, fx.glow { amount = 1 }";
  EXPECT_EQ(inside(two, {{"glow", "amount", number(2)}}), "fx.glow { amount = 2 }, fx.glow { amount = 1 }");
  EXPECT_EQ(inside(two, {{"glow#2", "amount", number(2)}}), "fx.glow { amount = 1 }, fx.glow { amount = 2 }");
  EXPECT_EQ(inside(two, {{"glow#2", "knee", number(1)}, {"glow", "knee", number(0)}}),
            "fx.glow { amount = 1, knee = 0 }, fx.glow { amount = 1, knee = 1 }");
  EXPECT_EQ(inside("fx.glow { order = 9 }, fx.glow { name = \"first\", order = 1 }", {{"first", "steps", whole(1)}}),
            "fx.glow { order = 9 }, fx.glow { name = \"first\", order = 1, steps = 1 }");
}

TEST_F(WriteBack, WhatIsComputedStays) {
  const auto one = [&](const std::string& value) {
    return refusal(head + "fx.glow {\n  amount = " + value + " }" + tail, {{"glow", "amount", number(2)}});
  };
  const std::string stays = "preset.lua:4: error: glow.amount is computed and stays as it is: ";
  EXPECT_EQ(one("0.5 * 3"), stays + "0.5 * 3");
  EXPECT_EQ(one("(1)"), stays + "(1)");
  EXPECT_EQ(one("math.max(1, 3)"), stays + "math.max(1, 3)");
  EXPECT_EQ(one("fx.curve { { 1, 0 }, { 9, 2 } }"), stays + "fx.curve { { 1, 0 }, { 9, 2 } }");
  EXPECT_EQ(one("function(t) return t.frame, 3 end"), stays + "function(t) return t.frame, 3 end");
  EXPECT_EQ(refusal("local fx = require \"afterglow\"\nlocal k = 0.1\nreturn fx.stack { fx.glow { knee = k } }",
                    {{"glow", "knee", number(1)}}),
            "preset.lua:3: error: glow.knee is computed and stays as it is: k");
  EXPECT_EQ(refusal("local fx = require \"afterglow\"\nlocal all = { knee = 0.1 }\nreturn fx.stack { fx.glow(all) }",
                    {{"glow", "knee", number(1)}}),
            "preset.lua:3: error: glow.knee is computed and stays as it is: all");
  // The one is refused, the other is made.
  const auto out = rewrite(head + "fx.glow { amount = 1 + 1, knee = 0 }" + tail,
                           {{"glow", "amount", number(3)}, {"glow", "knee", number(1)}});
  ASSERT_TRUE(out);
  EXPECT_EQ(out->text, head + "fx.glow { amount = 1 + 1, knee = 1 }" + tail);
  ASSERT_THAT(out->refused, SizeIs(1));
  EXPECT_EQ(out->refused[0].edit.setting, "amount");
  ASSERT_THAT(out->written, SizeIs(1));
  EXPECT_EQ(out->written[0].line, 3);
  EXPECT_EQ(out->written[0].before, "0");
  EXPECT_EQ(out->written[0].after, "1");
}

TEST_F(WriteBack, EntriesThatAreMadeTogetherStay) {
  const std::string loop =
      "local fx = require \"afterglow\"\nlocal all = {}\nfor i = 1, 3 do\n  all[i] = fx.glow { knee = 0.1 "
      "}\nend\nreturn fx.stack(all)\n";
  EXPECT_THAT(refusal(loop, {{"glow#2", "knee", number(1)}}),
              HasSubstr("preset.lua:4: error: glow#2.knee cannot be changed alone: 3 entries are made on this line"));
  EXPECT_THAT(refusal(head + "fx.glow { }, fx.glow { knee = 1 and 0.1 }" + tail, {{"glow#2", "knee", number(0.5)}}),
              HasSubstr("preset.lua:3: error: glow#2.knee is computed and stays as it is: 1 and 0.1"));
  EXPECT_THAT(refusal(loop, {{"glow", "knee", number(1)}}), HasSubstr("cannot be changed alone"));
  EXPECT_THAT(
      refusal(loop, {{"glow", "knee", number(1)}, {"glow#2", "knee", number(1)}, {"glow#3", "knee", number(2)}}),
      HasSubstr("cannot be changed alone"));
}

TEST_F(WriteBack, EntriesThatAreMadeTogetherChangeTogether) {
  const std::string loop =
      "local fx = require \"afterglow\"\nlocal all = {}\nfor i = 1, 3 do\n  all[i] = fx.glow { knee = 0.1 "
      "}\nend\nreturn fx.stack(all)\n";
  const auto out =
      rewrite(loop, {{"glow", "knee", number(1)}, {"glow#2", "knee", number(1)}, {"glow#3", "knee", number(1)}});
  ASSERT_TRUE(out) << out.error().text();
  EXPECT_TRUE(out->refused.empty());
  EXPECT_THAT(out->text, HasSubstr("all[i] = fx.glow { knee = 1 }"));
  EXPECT_EQ(out->written.size(), 3u);
}

TEST_F(WriteBack, ValuesThatAreThereAlreadyAreNoChange) {
  const std::string text = head + "fx.glow { amount = 2 * 1, knee = 0.10 }" + tail;
  const auto out =
      rewrite(text, {{"glow", "amount", number(2)}, {"glow", "knee", number(0.1f)}, {"glow", "steps", whole(4)}});
  ASSERT_TRUE(out);
  EXPECT_EQ(out->text, text);
  EXPECT_THAT(out->written, IsEmpty());
  EXPECT_THAT(out->refused, IsEmpty());
}

TEST_F(WriteBack, BackToTheDefault) {
  const auto reset = [&](const std::string& entries, const char* setting) {
    return inside(entries, {{"glow", setting, std::nullopt}});
  };
  EXPECT_EQ(reset("fx.glow { amount = 2 }", "amount"), "fx.glow {}");
  EXPECT_EQ(reset("fx.glow { amount = 2, knee = 1 }", "amount"), "fx.glow { knee = 1 }");
  EXPECT_EQ(reset("fx.glow { amount = 2, knee = 1 }", "knee"), "fx.glow { amount = 2 }");
  EXPECT_EQ(reset("fx.glow { amount = 2, knee = 1, }", "knee"), "fx.glow { amount = 2, }");
  EXPECT_EQ(reset("fx.glow {\n  amount = 2,\n  knee = 1,\n}", "amount"), "fx.glow {\n  knee = 1,\n}");
  EXPECT_EQ(reset("fx.glow {\n  amount = 2,\n  knee = 1\n}", "knee"), "fx.glow {\n  amount = 2\n}");
  EXPECT_EQ(reset("fx.glow { amount = 2, knee = 1,\n  steps = 1 }", "knee"), "fx.glow { amount = 2,\n  steps = 1 }");
  EXPECT_EQ(reset("fx.glow { amount = 2, -- much\n  steps = 1 }", "amount"),
            "fx.glow { amount = 0.5, -- much\n  steps = 1 }");
  EXPECT_EQ(reset("fx.glow {\n  -- much\n  amount = 2,\n}", "amount"), "fx.glow {\n  -- much\n  amount = 0.5,\n}");
  EXPECT_EQ(reset("fx.glow { amount = 2, amount = 3 }", "amount"), "fx.glow { amount = 2, amount = 0.5 }");
  EXPECT_EQ(reset("fx.glow { knee = 1 }", "amount"), "fx.glow { knee = 1 }");
  EXPECT_EQ(reset("fx.glow { enabled = false }", "enabled"), "fx.glow {}");
}

TEST_F(WriteBack, KeysOfTheEntry) {
  EXPECT_EQ(inside("fx.glow {}", {{"glow", "enabled", boolean(false)}}), "fx.glow { enabled = false }");
  EXPECT_EQ(inside("fx.glow { enabled = false }", {{"glow", "enabled", boolean(true)}}), "fx.glow { enabled = true }");
  EXPECT_EQ(inside("fx.glow { at = \"post_process\", order = 0 }",
                   {{"glow", "at", choice("after_post_process")}, {"glow", "order", whole(7)}}),
            "fx.glow { at = \"after_post_process\", order = 7 }");
}

TEST_F(WriteBack, PresetsThatExtendOthers) {
  scene.write("base.lua",
              head + "fx.glow { knee = 0.5,\n  amount = fx.curve { { 1, 0 }, { 2, 1 } } },\nfx.glow {}" + tail);
  const std::string extend = "local fx = require \"afterglow\"\nreturn fx.extend(\"base\", ";
  const PresetEdit knee{"glow", "knee", number(1)};
  EXPECT_EQ(edited(extend + "{ glow = { knee = 0.75 } })", {knee}), extend + "{ glow = { knee = 1 } })");
  EXPECT_EQ(edited(extend + "{ glow = { steps = 1 } })", {knee}), extend + "{ glow = { steps = 1, knee = 1 } })");
  EXPECT_EQ(edited(extend + "{ name = \"Mine\" })", {knee}), extend + "{ name = \"Mine\", glow = { knee = 1 } })");
  EXPECT_EQ(edited(extend + "{})", {{"glow#2", "knee", number(1)}}), extend + "{ [\"glow#2\"] = { knee = 1 } })");
  const std::string bare = "local fx = require \"afterglow\"\nreturn fx.extend(\"base\")";
  EXPECT_EQ(edited(bare, {knee}),
            "local fx = require \"afterglow\"\nreturn fx.extend(\"base\", { glow = { knee = 1 } })");
  // The default instead of the base's value cannot come from leaving the key out.
  EXPECT_EQ(edited(extend + "{ glow = { knee = 0.75 } })", {{"glow", "knee", std::nullopt}}),
            extend + "{ glow = { knee = 0.25 } })");
  EXPECT_EQ(refusal(extend + "{})", {{"glow", "amount", number(1)}}),
            "base.lua:4: error: glow.amount is a curve or a function and stays as it is");
  // What is added here is changed where it stands.
  EXPECT_EQ(edited(extend + "{ fx.glow { steps = 1 } })", {{"glow#3", "steps", whole(2)}}),
            extend + "{ fx.glow { steps = 2 } })");
}

TEST_F(WriteBack, EntriesOfRequiredScriptsStay) {
  scene.write("common.lua", "local fx = require \"afterglow\"\nreturn {\n  fx.glow { knee = 0.5 } }");
  EXPECT_EQ(
      refusal("local fx = require \"afterglow\"\nreturn fx.stack(require \"common\")", {{"glow", "knee", number(1)}}),
      "common.lua:3: error: glow.knee: the entry is made here, not in preset.lua, which alone is changed");
}

TEST_F(WriteBack, Volumes) {
  const std::string text = head +
                           "fx.glow { knee = 0.5 },\nfx.volume { name = \"cave\", weight = 0.5,\n  settings = { glow = "
                           "{ knee = 1, steps = 8 - 1 } } }" +
                           tail;
  const PresetEdit knee{"glow", "knee", number(0.75), "cave"};
  const auto out = rewrite(text, {knee, {"glow", "amount", number(2), "cave"}, {"glow", "steps", whole(1), "cave"}});
  ASSERT_TRUE(out) << out.error().text();
  EXPECT_EQ(out->text, head +
                           "fx.glow { knee = 0.5 },\nfx.volume { name = \"cave\", weight = 0.5,\n  settings = { glow = "
                           "{ knee = 0.75, steps = 8 - 1, amount = 2 } } }" +
                           tail);
  ASSERT_THAT(out->refused, SizeIs(1));
  EXPECT_EQ(scene.shorten(out->refused[0].reason.text()),
            "preset.lua:5: error: cave: glow.steps is computed and stays as it is: 8 - 1");
  // The entry's own value can be written; that volumes change it is said.
  const auto own = rewrite(text, {{"glow", "knee", number(0.1)}});
  ASSERT_TRUE(own);
  EXPECT_THAT(own->text, HasSubstr("fx.glow { knee = 0.1 }"));
  EXPECT_THAT(own->notes, ElementsAre(HasSubstr("glow.knee: volumes are blended over it")));
  EXPECT_EQ(edited(text, {{"glow", "knee", std::nullopt, "cave"}}),
            head +
                "fx.glow { knee = 0.5 },\nfx.volume { name = \"cave\", weight = 0.5,\n  settings = { glow = { steps = "
                "8 - 1 } } }" +
                tail);
}

TEST_F(WriteBack, NothingElseMayChange) {
  // The table is shared: writing it for one entry would change the other.
  const std::string shared =
      "local fx = require \"afterglow\"\nlocal one = fx.glow { knee = 0 }\nreturn fx.stack { one, one }";
  EXPECT_THAT(refusal(shared, {{"glow", "knee", number(1)}}), HasSubstr("cannot be changed alone: 2 entries"));
  // A script that looks at itself: the other entry follows.
  const std::string linked =
      "local fx = require \"afterglow\"\nlocal t = { knee = 0 }\nlocal function f(a) t.knee = a.knee return fx.glow(a) "
      "end\n"
      "return fx.stack {\n  f { knee = 0.5 },\n  fx.glow(t) }";
  const std::string reason = refusal(linked, {{"glow", "knee", number(1)}});
  EXPECT_THAT(reason, HasSubstr("glow.knee")) << reason;
}

TEST_F(WriteBack, Messages) {
  const auto error = [&](const PresetEdit& edit) {
    const auto out = rewrite(head + "fx.glow {}" + tail, {edit});
    EXPECT_EQ(out->text, out->before);
    return out->refused.empty() ? "" : out->refused[0].reason.text();
  };
  EXPECT_THAT(error({"glo", "knee", number(1)}),
              HasSubstr("the stack has no entry 'glo'; allowed: glow; did you mean 'glow'?"));
  EXPECT_THAT(error({"glow", "kne", number(1)}), HasSubstr("effect 'glow' has no setting 'kne'; allowed: amount, knee, "
                                                           "steps, soft, mode, tint, offset, at, blend, enabled, "
                                                           "mask, opacity, order; did you mean 'knee'?"));
  EXPECT_THAT(error({"glow", "knee", number(2)}), HasSubstr("glow.knee = 2 is out of range; allowed: 0…1"));
  EXPECT_THAT(error({"glow", "knee", whole(1)}), HasSubstr("glow.knee is of another type; allowed: 0…1"));
  EXPECT_THAT(error({"glow", "knee", number(1), "cave"}), HasSubstr("the stack has no volume 'cave'"));
  EXPECT_THAT(rewrite("return 1", {}).error().text(), HasSubstr("a preset must return fx.stack"));
}

TEST_F(WriteBack, TextsForEditsAreReadAsOverridesAre) {
  scene.stack("fx.glow {}, fx.glow { name = \"other\" }");
  const auto preset = scene.load();
  ASSERT_TRUE(preset);
  const auto edits = parse_edits(*preset, {{"glow", "tint", "#ff0000"}, {"other", "enabled", "false"}});
  ASSERT_TRUE(edits) << edits.error().text();
  ASSERT_THAT(*edits, SizeIs(2));  // "glow" is a name here, and so not the effect of both
  EXPECT_EQ((*edits)[0].value, color(1, 0, 0));
  EXPECT_EQ((*edits)[1].name(), "other.enabled");
  EXPECT_THAT(parse_edits(*preset, {{"glow", "knee", "much"}}).error().text(),
              HasSubstr("glow.knee = \"much\" is not a number"));
  EXPECT_THAT(parse_resets(*preset, {"glow"}).error().text(),
              HasSubstr("'glow' is no setting; allowed: ENTRY.SETTING"));
}

// ---- the file

TEST_F(WriteBack, SavesKeepModeAndLinks) {
  scene.write("real/look.lua", head + "fx.glow { knee = 0.1 }" + tail);
  std::filesystem::create_symlink("real/look.lua", scene.folder() / "link.lua");
  chmod((scene.folder() / "real/look.lua").c_str(), 0640);
  PresetWriter writer(scene.folder() / "link.lua", scene.options);
  const auto plan = writer.plan({{"glow", "knee", number(0.9)}});
  ASSERT_TRUE(plan) << plan.error().text();
  ASSERT_TRUE(writer.save(*plan));
  EXPECT_TRUE(std::filesystem::is_symlink(scene.folder() / "link.lua"));
  EXPECT_EQ(*read_file(scene.folder() / "real/look.lua"), head + "fx.glow { knee = 0.9 }" + tail);
  struct stat status {};
  stat((scene.folder() / "real/look.lua").c_str(), &status);
  EXPECT_EQ(status.st_mode & 07777, 0640u);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(scene.folder() / "real"), {}), 1);
}

TEST_F(WriteBack, SavesOfFilesThatChangedAreRefused) {
  scene.stack("fx.glow { knee = 0.1 }");
  PresetWriter writer(file(), scene.options);
  const auto plan = writer.plan({{"glow", "knee", number(0.9)}});
  ASSERT_TRUE(plan);
  scene.stack("fx.glow { knee = 0.2 }");
  const auto saved = writer.save(*plan);
  ASSERT_FALSE(saved);
  EXPECT_EQ(saved.error().kind, ErrorKind::io);
  EXPECT_THAT(saved.error().text(), HasSubstr("was changed by something else in the meantime; nothing was written"));
  EXPECT_THAT(*read_file(file()), HasSubstr("knee = 0.2"));
  EXPECT_EQ(writer.saves(), 0u);
}

// Two who have planned on the same text: the second to save is told so.
TEST_F(WriteBack, OfTwoSavesAtOnceOneIsRefused) {
  for (int round = 0; round < 20; ++round) {
    scene.stack("fx.glow { knee = 0.1, amount = 0.1 }");
    PresetWriter a(file(), scene.options), b(file(), scene.options);
    const auto of_a = a.plan({{"glow", "knee", number(0.9)}}), of_b = b.plan({{"glow", "amount", number(0.9)}});
    ASSERT_TRUE(of_a && of_b);
    std::atomic<int> ready = 0;
    const auto save = [&](PresetWriter& writer, const Rewrite& rewrite) {
      ++ready;
      while (ready < 2) std::this_thread::yield();
      return writer.save(rewrite).ok();
    };
    auto other = std::async(std::launch::async, [&] { return save(a, *of_a); });
    const bool mine = save(b, *of_b);
    EXPECT_NE(other.get(), mine) << round;
  }
}

TEST_F(WriteBack, UndoTakesBackSaveBySave) {
  scene.stack("fx.glow { knee = 0.1 }");
  const std::string first = *read_file(file());
  PresetWriter writer(file(), scene.options);
  ASSERT_TRUE(writer.save(*writer.plan({{"glow", "knee", number(0.2)}})));
  const std::string second = *read_file(file());
  ASSERT_TRUE(writer.save(*writer.plan({{"glow", "steps", whole(1)}})));
  ASSERT_TRUE(writer.undo());
  EXPECT_EQ(*read_file(file()), second);
  scene.write("preset.lua", second + "-- mine\n");
  EXPECT_THAT(writer.undo().error().text(), HasSubstr("was changed by something else"));
  scene.write("preset.lua", second);
  ASSERT_TRUE(writer.undo());
  EXPECT_EQ(*read_file(file()), first);
  EXPECT_THAT(writer.undo().error().text(), HasSubstr("nothing was saved"));
}

}  // namespace
}  // namespace afterglow::test
