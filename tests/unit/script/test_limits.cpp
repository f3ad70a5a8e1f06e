// SPDX-License-Identifier: MIT
// Hostile scripts: each ends in one clear error, whatever it tries to swallow it with, and the host lives on.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene.h"

namespace afterglow::test {
namespace {

// A small budget, so that the suite is quick; the clock's limit is far away unless a test sets it.
std::string run(const std::string& statements, std::size_t memory = 16u << 20) {
  Scene scene;
  scene.options.limits = {memory, 2'000'000, 60};
  scene.preset("local fx = require \"afterglow\"\n" + statements + "\nreturn fx.stack {}\n");
  return scene.load_error();
}

const std::string kBudget = "error: instruction budget spent: more than 2000000 instructions or 60 s";
const std::string kMemory = "preset.lua: error: memory limit reached: more than 16 MiB";
const std::string kMemoryAt2 = "preset.lua:2: error: memory limit reached: more than 16 MiB";
const std::string kMemoryAt3 = "preset.lua:3: error: memory limit reached: more than 16 MiB";

TEST(Limits, DefaultsAreThoseOfTheDesign) {
  const ScriptLimits limits;
  EXPECT_EQ(limits.memory, 64u << 20);
  EXPECT_EQ(limits.instructions, 50'000'000u);
  EXPECT_EQ(limits.seconds, 2.0);
}

TEST(Limits, EndlessLoops) {
  EXPECT_EQ(run("while true do end"), "preset.lua:2: " + kBudget);
  EXPECT_EQ(run("\n\nrepeat local x = 1 until false"), "preset.lua:4: " + kBudget);
  EXPECT_EQ(run("for i = 1, math.maxinteger do end"), "preset.lua:2: " + kBudget);
  EXPECT_EQ(run("::a:: goto a"), "preset.lua:2: " + kBudget);
}

TEST(Limits, PcallCannotSwallowTheBudget) {
  EXPECT_EQ(run("while true do pcall(function() while true do end end) end"), "preset.lua:2: " + kBudget);
  EXPECT_EQ(run("local function f() pcall(f) while true do end end\npcall(f)\n"), "preset.lua:2: " + kBudget);
  EXPECT_EQ(run("pcall(function() while true do end end)"), "preset.lua:2: " + kBudget);  // and then goes on
}

TEST(Limits, LoopsInMetamethods) {
  EXPECT_EQ(run("tostring(setmetatable({}, { __tostring = function()\n while true do end end }))"),
            "preset.lua:3: " + kBudget);
  EXPECT_EQ(run("local t = setmetatable({}, { __index = function()\n while true do end end }) local x = t.y"),
            "preset.lua:3: " + kBudget);
  EXPECT_EQ(run("do local c <close> = setmetatable({}, { __close = function()\n while true do end end }) end"),
            "preset.lua:3: " + kBudget);
  EXPECT_THAT(run("local function again() local c <close> = setmetatable({}, { __close = function() again() end }) "
                  "error(\"x\") end\nwhile true do pcall(again) end",
                  64u << 20),
              testing::HasSubstr(kBudget));
  EXPECT_EQ(run("local t = setmetatable({}, { __newindex = function(t, k, v)\n while true do end end }) t.y = 1"),
            "preset.lua:3: " + kBudget);
}

TEST(Limits, CloseHandlersCannotGoOnAfterTheBudget) {
  EXPECT_EQ(run(R"(local function guard(f) return setmetatable({}, { __close = f }) end
    pcall(function()
      local a <close> = guard(function() while true do end end)
      local b <close> = guard(function() while true do end end)
      while true do end
    end))"),
            "preset.lua:6: " + kBudget);
}

TEST(Limits, DeepRecursion) {
  Scene scene;  // with the limits of every day
  scene.preset("local function f() return 1 + f() end\nf()");
  EXPECT_EQ(scene.load_error(), "preset.lua:1: error: stack overflow: calls nest more than 10000 deep");
  EXPECT_EQ(run("local function f() return f() end\nf()"), "preset.lua:2: " + kBudget);  // a tail call is a loop
  EXPECT_EQ(run("local function f() local ok, e = pcall(f) error(e, 0) end\nf()"),
            "preset.lua:2: error: C stack overflow");
  EXPECT_EQ(run("local t = {} setmetatable(t, { __index = t })\nlocal x = t.y"),
            "preset.lua:3: error: '__index' chain too long; possible loop");
  EXPECT_EQ(run("local m = {} m.__index = function(t, k) return t[k] end\nlocal x = setmetatable({}, m).y"),
            "preset.lua:2: error: C stack overflow");
}

TEST(Limits, DeepSyntax) {
  const auto nested = [](int depth) {
    return "local x = " + std::string(static_cast<std::size_t>(depth), '(') + "1" +
           std::string(static_cast<std::size_t>(depth), ')');
  };
  EXPECT_EQ(run(nested(100)), "");
  EXPECT_EQ(run(nested(100000)), "preset.lua: error: C stack overflow");
}

TEST(Limits, Memory) {
  EXPECT_EQ(run("local s = (\"x\"):rep(1e9)"), kMemoryAt2);
  EXPECT_EQ(run("local s = \"x\"\nwhile true do s = s .. s end"), kMemoryAt3);
  EXPECT_EQ(run("local t = {}\nfor i = 1, 1e9 do t[i] = i end"), kMemoryAt3);
  EXPECT_EQ(run("local t = {}\nfor i = 1, 1e9 do t = { t, {}, {}, {} } end"), kMemoryAt3);
  EXPECT_EQ(run("local t = { (\"x\"):rep(1e6):byte(1, -1) }").substr(0, 21), "preset.lua:2: error: ");
  EXPECT_EQ(
      run("local t = {} for i = 1, 1e5 do t[i] = \"0123456789\" end local s = table.concat(t, (\"y\"):rep(1000))"),
      kMemory);
  EXPECT_EQ(run("string.format((\"%99d\"):rep(100), table.unpack({}))").substr(0, 21), "preset.lua:2: error: ");
  EXPECT_EQ(run("string.format(\"%1000d\", 1)"), "preset.lua:2: error: invalid conversion specification: '%1000d'");
  EXPECT_EQ(run("local x = select(2, pcall(string.rep, \"x\", -1)) assert(x == \"\")"), "");
}

TEST(Limits, PcallCannotSwallowTheMemoryLimit) {
  EXPECT_EQ(run("while true do pcall(string.rep, \"x\", 1e9) end"), kMemoryAt2);
  EXPECT_EQ(run("pcall(function() local t = {}\nfor i = 1, 1e9 do t[i] = i end end)"), kMemoryAt3);
}

TEST(Limits, ThrashingAtTheMemoryLimitIsCounted) {
  // Fills the memory almost, then makes garbage that every time forces a full collection.
  const std::string error = run(R"(local keep = {}
    for i = 1, 150000 do keep[i] = { i } end
    while true do local waste = ("x"):rep(900000) end)");
  EXPECT_TRUE(error.find("instruction budget") != std::string::npos || error.find("memory limit") != std::string::npos)
      << error;
}

// Repeats an operation that is one call for the script and much work for the host. Uncounted, a budget of 2 million
// instructions allows far more than 5000 of them.
std::string repeated(const std::string& setup, const std::string& operation) {
  Scene scene;
  scene.options.limits = {16u << 20, 2'000'000, 60};
  scene.preset(setup + " local n = 0 while true do n = n + 1 if n == 5000 then print(\"uncounted\") end " + operation +
               " end");
  const std::string error = scene.load_error();
  return scene.notes.empty() ? error : scene.notes[0];
}

TEST(Limits, NativeWorkIsCounted) {
  const std::string list = "local t = {} for i = 1, 1e4 do t[i] = i end";
  const std::string text = "local s = (\"1\"):rep(1e5)";
  const std::string spent = "preset.lua:1: " + kBudget;
  EXPECT_EQ(repeated(list, "table.insert(t, 1, 0) t[#t] = nil"), spent);
  EXPECT_EQ(repeated(list, "table.remove(t, 1) t[#t + 1] = 0"), spent);
  EXPECT_EQ(repeated(list, "table.sort(t)"), spent);
  EXPECT_EQ(repeated(list, "table.concat(t)"), spent);
  EXPECT_EQ(repeated(list, "for k in pairs(t) do break end"), spent);
  EXPECT_EQ(repeated(text, "tonumber(s, 36)"), spent);
  EXPECT_EQ(repeated(text, "local u = s:upper()"), spent);
  EXPECT_EQ(repeated(text, "local u = s .. n"), spent);
  EXPECT_EQ(repeated("local s = \"1\"", "local u = s:upper()"),
            "preset.lua:1: uncounted");  // what the check looks like
  EXPECT_EQ(run("table.concat({}, \"\", 1, 1e15)"),
            "preset.lua:2: error: table.concat: item 1 is a nil; allowed: texts and numbers");
}

TEST(Limits, FailingInALoopIsCounted) {
  EXPECT_EQ(run("while true do pcall(function() return fx.nope end) end"), "preset.lua:2: " + kBudget);
  EXPECT_EQ(run("while true do pcall(require, \"nope\") end"), "preset.lua:2: " + kBudget);
  EXPECT_EQ(run("while true do pcall(fx.stack, { zzz = 1 }) end"), "preset.lua:2: " + kBudget);
  EXPECT_EQ(run("while true do pcall(fx.filters.plus, -1) end"), "preset.lua:2: " + kBudget);
}

TEST(Limits, DeclaringIsBounded) {
  EXPECT_EQ(run("while true do fx.bool { default = true } end"), "preset.lua:2: error: more than 4096 settings");
  EXPECT_EQ(run("local t = {} for i = 1, 5000 do t[i] = 1 end fx.stack(t)"),
            "preset.lua:2: error: fx.stack has more than 4096 keys");
  EXPECT_EQ(run("local f = function() end while true do fx.effect { name = \"a\", build = f } end"),
            "preset.lua:2: error: more than 4096 effects");
}

TEST(Limits, TheClockAlsoCounts) {
  Scene scene;
  scene.options.limits = {64u << 20, ~0ull, 0.05};
  scene.preset("while true do end");
  EXPECT_EQ(scene.load_error(),
            "preset.lua:1: error: instruction budget spent: more than 18446744073709551615 instructions or 0.05 s");
}

TEST(Limits, HugeScriptsAreRefused) {
  Scene scene;
  scene.preset("--" + std::string(2u << 20, 'x'));
  EXPECT_EQ(scene.load_error(), "preset.lua: error: is larger than 1048576 bytes");
}

TEST(Limits, ATinyLimitIsAnErrorToo) {
  Scene scene;
  scene.options.limits.memory = 1000;
  scene.preset("");
  EXPECT_EQ(scene.load_error(), "error: memory limit of 1000 bytes is too small");
  scene.options.limits.memory = 20000;
  EXPECT_NE(scene.load_error().find("memory limit"), std::string::npos);
}

TEST(Limits, BuildsHaveABudgetEach) {
  Scene scene;
  scene.options.limits = {16u << 20, 2'000'000, 60};
  scene.effect("busy", R"(build = function(g, s, source)
    for i = 1, 300000 do end
    return source
  end,)");
  scene.stack("fx.busy {}");
  auto preset = scene.load();
  ASSERT_TRUE(preset);
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(scene.build(*preset)) << i;
}

TEST(Limits, AFailedBuildLeavesAUsableState) {
  Scene scene;
  scene.options.limits = {16u << 20, 2'000'000, 60};
  scene.effect("moody", R"(build = function(g, s, source)
    if g.frame == 1 then while true do pcall(function() while true do end end) end end
    if g.frame == 2 then local t = {} for i = 1, 1e9 do t[i] = { i } end end
    return source
  end,)");
  scene.stack("fx.moody {}");
  auto preset = scene.load();
  ASSERT_TRUE(preset);
  for (int round = 0; round < 3; ++round) {
    scene.context.frame = 1;
    EXPECT_EQ(scene.shorten(scene.build(*preset).error().text()),
              "effects/moody.lua:4: " + kBudget + "\n  in effect 'moody' of preset.lua:3");
    scene.context.frame = 2;
    EXPECT_EQ(scene.shorten(scene.build(*preset).error().text()),
              "effects/moody.lua:5: error: memory limit reached: more than 16 MiB\n  in effect 'moody' of "
              "preset.lua:3\n  in frame 2");
    scene.context.frame = 3;
    EXPECT_TRUE(scene.build(*preset));
  }
}

TEST(Limits, ListsInListsAreCounted) {
  EXPECT_EQ(run("local t = {} for i = 1, 8 do t[i] = t end\nlocal s = fx.stack { t }"),
            "preset.lua:3: error: fx.stack: position 1 is a list that holds itself");
  EXPECT_THAT(run("local t = { false } for i = 1, 31 do t = { t, t } end\nlocal s = fx.stack { t }"),
              testing::HasSubstr(kBudget));
  EXPECT_THAT(run("local t = { false } for i = 1, 31 do t = { t, t } end\nlocal s = fx.group { t }"),
              testing::HasSubstr(kBudget));
  EXPECT_EQ(run("local t = { false, false } local s = fx.stack { t, { t, t }, t }"), "");
}

TEST(Limits, WhatStandsForManyIsCounted) {
  Scene scene;
  scene.effect("many", R"(settings = { a = fx.float { default = 0 }, b = fx.float { default = 0 } },
    build = function(g, s, source) return source end,)");
  const auto load = [&](const std::string& text) {
    scene.preset(
        "local fx = require \"afterglow\"\nlocal all = {}\n"
        "for i = 1, 1000 do all[i] = fx.many { name = \"e\" .. i } end\n" +
        text);
    return scene.load_error();
  };
  // Volumes that aim at an effect aim at each of its entries.
  EXPECT_THAT(load("for i = 1, 40 do all[#all + 1] = fx.volume { settings = { many = { a = 1, b = 2 } } } end\n"
                   "return fx.stack(all)\n"),
              testing::HasSubstr("volumes set more than 65536 settings of entries"));
  EXPECT_EQ(load("for i = 1, 10 do all[#all + 1] = fx.volume { settings = { many = { a = 1, b = 2 } } } end\n"
                 "return fx.stack(all)\n"),
            "");
  EXPECT_THAT(load("local last for i = 1, 100 do last = fx.stack(all) end return last\n"),
              testing::HasSubstr("more than 65536 effects in all stacks"));
  scene.preset(
      "local fx = require \"afterglow\"\nlocal keys, all = {}, {}\nfor i = 1, 2000 do keys[i] = { i, i } end\n"
      "local curve = fx.curve(keys)\nfor i = 1, 200 do all[i] = fx.many { a = curve } end\nreturn fx.stack(all)\n");
  EXPECT_THAT(scene.load_error(), testing::HasSubstr("the curves of all settings have more than 262144 keys"));
}

}  // namespace
}  // namespace afterglow::test
