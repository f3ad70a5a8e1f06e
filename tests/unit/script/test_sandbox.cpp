// SPDX-License-Identifier: MIT
// What scripts must not reach, one test a way out; and what they may rely on instead.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene.h"

namespace afterglow::test {
namespace {

using testing::ElementsAre;

// Runs the statements in a preset and returns its error; "" when it loads.
std::string run_statements(const std::string& statements) {
  Scene scene;
  scene.preset(statements + "\nreturn require(\"afterglow\").stack {}\n");
  return scene.load_error();
}

// The statements must hold `assert`s.
#define EXPECT_RUNS(statements) EXPECT_EQ(run_statements(statements), "")

class Absent : public testing::TestWithParam<const char*> {};

TEST_P(Absent, IsNotThere) {
  EXPECT_THAT(run_statements(std::string("print(") + GetParam() + ")"),
              testing::StartsWith("preset.lua:1: error: there is no "));
}

// Names that nobody made are errors: nil would leave a setting at its default, and no one would know.
TEST(Sandbox, MisspeltNamesAreToldWithTheNearest) {
  const std::string told = "error: nothing here has the name '",
                    visible =
                        "'; allowed: variables and functions that stand above this line, and those of the library";
  const std::string strength = told + "strenght" + visible + "; did you mean 'strength'?";
  EXPECT_EQ(run_statements("local strength = 2\nlocal t = { intensity = strenght }"), "preset.lua:2: " + strength);
  EXPECT_EQ(run_statements("strength = 2\nprint(strenght)"), "preset.lua:2: " + strength);
  EXPECT_EQ(run_statements("local strength = 2\nlocal function f()\n  return strength + strenght\nend\nf()"),
            "preset.lua:3: " + strength);
  EXPECT_EQ(run_statements("requir(\"afterglow\")"),
            "preset.lua:1: " + told + "requir" + visible + "; did you mean 'require'?");
  EXPECT_EQ(run_statements("local x = _G"), "preset.lua:1: " + told + "_G" + visible);
  EXPECT_THAT(run_statements("local x = math.sine"),
              testing::AllOf(testing::StartsWith("preset.lua:1: error: there is no math.sine; allowed: abs, "),
                             testing::EndsWith("; did you mean 'sin'?")));
  EXPECT_RUNS("local ok, why = pcall(function() return nobody end)\nassert(not ok)");
  EXPECT_RUNS("assert(math[1] == nil)\nlater = false\nassert(not later)");
}

// What is compared with has an end, however many names a script makes and however long they are.
TEST(Sandbox, ManyNamesDoNotSlowAMisspeltOne) {
  EXPECT_RUNS(
      "for i = 1, 3000 do _ENV[string.rep('x', i % 100) .. i] = i end\n"
      "for i = 1, 50 do assert(not pcall(function() return nobody end)) end");
}

INSTANTIATE_TEST_SUITE_P(Sandbox, Absent,
                         testing::Values("io", "os", "debug", "package", "coroutine", "utf8", "load", "loadstring",
                                         "loadfile", "dofile", "collectgarbage", "warn", "next", "xpcall",
                                         "string.dump", "string.match", "string.gmatch", "string.gsub", "string.pack",
                                         "string.unpack", "(\"\").gsub", "(\"\").dump", "table.move", "math.random",
                                         "math.randomseed", "getfenv"));

TEST(Sandbox, TextIsFoundAsLuaFindsIt) {
  EXPECT_RUNS(
      "local first, last = ('bottom_left'):find('left')\nassert(first == 8 and last == 11)\n"
      "assert(('bottom_left'):find('right') == nil)\nassert(('a.b'):find('.', 1, true) == 2)\n"
      "assert(('abab'):find('ab', 2) == 3 and ('abab'):find('ab', -2) == 3 and ('abab'):find('ab', -9) == 1)\n"
      "assert(('abab'):find('ab', 4) == nil and ('ab'):find('', 3) == 3 and ('ab'):find('', 4) == nil)\n"
      "local at, before = ('ab'):find('')\nassert(at == 1 and before == 0)");
  EXPECT_EQ(run_statements("\nlocal at = ('a1'):find('%d')"),
            "preset.lua:2: error: string.find: '%d' is a pattern, which may run without end; allowed: plain text; with "
            "true behind it every sign stands for itself: text:find(\"a.b\", 1, true)");
}

TEST(Sandbox, WhatIsNotThereSaysWhy) {
  EXPECT_EQ(run_statements("io.open(\"/etc/passwd\")"),
            "preset.lua:1: error: there is no io here: presets reach no files, processes or clocks");
  EXPECT_EQ(
      run_statements("\nload(\"return 1\")"),
      "preset.lua:2: error: there is no load here: scripts come from files on the search path; require reads them");
  EXPECT_EQ(run_statements("local x = math.random()"),
            "preset.lua:1: error: there is no math.random here: every run must give the same pictures; make numbers of "
            "t.frame, g.frame or a setting");
  EXPECT_EQ(
      run_statements("nobody()"),
      "preset.lua:1: error: nothing here has the name 'nobody'; allowed: variables and functions that stand above "
      "this line, and those of the library");
}

TEST(Sandbox, PrecompiledScriptsAreRefused) {
  Scene scene;
  scene.preset(std::string("\x1BLua\x54\0\x19\x93\r\n", 10));
  EXPECT_EQ(scene.load_error(), "preset.lua: error: is precompiled Lua; only text is allowed");
}

TEST(Sandbox, LibrariesCannotBeChanged) {
  const std::string refused = "preset.lua:1: error: this table is read-only";
  EXPECT_EQ(run_statements("string.rep = print"), refused);
  EXPECT_EQ(run_statements("math.pi = 3"), refused);
  EXPECT_EQ(run_statements("table.insert = nil"), refused);
  EXPECT_EQ(run_statements("require(\"afterglow\").stack = print"), refused);
  EXPECT_EQ(run_statements("require(\"afterglow\").filters.tent = print"), refused);
  EXPECT_EQ(run_statements("rawset(math, \"pi\", 3)"), "preset.lua:1: error: rawset: this table is protected");
  EXPECT_EQ(run_statements("table.insert(math, 3)"), refused);
  EXPECT_EQ(run_statements("setmetatable(string, {})"),
            "preset.lua:1: error: setmetatable: this metatable is protected");
}

TEST(Sandbox, MetatablesOfOthersAreHidden) {
  EXPECT_RUNS("assert(getmetatable(\"\") == false)");
  EXPECT_RUNS("assert(getmetatable(string) == false)");
  EXPECT_RUNS("assert(getmetatable(require(\"afterglow\")) == false)");
  EXPECT_RUNS("assert(getmetatable(require(\"afterglow\").bool { default = true }) == false)");
  EXPECT_RUNS("assert(getmetatable(_ENV) == false)");
  EXPECT_RUNS("local t = {} assert(getmetatable(setmetatable({}, t)) == t)");
}

TEST(Sandbox, FinalizersAreRefused) {
  EXPECT_EQ(run_statements("setmetatable({}, { __gc = function() end })"),
            "preset.lua:1: error: setmetatable: __gc is not allowed");
  EXPECT_EQ(run_statements("local m = setmetatable({}, { __index = function() return print end }) setmetatable({}, m)"),
            "");
}

TEST(Sandbox, GlobalsOfOneFileStayInIt) {
  Scene scene;
  scene.write("one.lua", "leak = 5\nprint = nil\nreturn true");
  scene.preset(
      "require \"one\"\nassert(rawget(_ENV, \"leak\") == nil and print)\nreturn require(\"afterglow\").stack {}");
  EXPECT_EQ(scene.load_error(), "");
}

TEST(Sandbox, PairsHasOneOrder) {
  Scene scene;
  scene.preset(R"(
    local t = { zeta = 1, alpha = 2, [3] = 3, [1] = 1, [2.5] = 0, [-1] = 0, [true] = 1, [false] = 0, Beta = 1, [""] = 0 }
    for i = 1, 3 do t["k" .. i] = i end
    local out = {}
    for k in pairs(t) do out[#out + 1] = tostring(k) end
    print(table.concat(out, " "))
    return require("afterglow").stack {})");
  ASSERT_EQ(scene.load_error(), "");
  EXPECT_THAT(scene.notes, ElementsAre("preset.lua:6: -1 1 2.5 3  Beta alpha k1 k2 k3 zeta false true"));
}

TEST(Sandbox, PairsSkipsWhatIsRemovedAndRefusesOddKeys) {
  EXPECT_RUNS("local t, n = { a = 1, b = 2, c = 3 }, 0 for k in pairs(t) do t.b = nil n = n + 1 end assert(n == 2)");
  EXPECT_RUNS("local n = 0 for k, v in pairs({}) do n = n + 1 end assert(n == 0)");
  EXPECT_RUNS("local n = 0 for k, v in pairs(math) do n = n + 1 end assert(n > 10)");
  EXPECT_EQ(run_statements("for k in pairs({ [{}] = 1 }) do end"),
            "preset.lua:1: error: pairs: a key is a table, which has no place in an order; allowed: numbers, texts and "
            "booleans as keys");
}

TEST(Sandbox, TextsHoldNoAddresses) {
  EXPECT_RUNS("assert(tostring({}) == \"table\" and tostring(print) == \"function\")");
  EXPECT_RUNS("assert(string.format(\"%s %s\", {}, 5) == \"table 5\")");
  EXPECT_RUNS("assert(tostring(require(\"afterglow\").stack {}) == \"stack\")");
  EXPECT_EQ(run_statements("string.format(\"%5p\", {})"),
            "preset.lua:1: error: string.format: %p is not allowed (addresses differ from run to run)");
  EXPECT_EQ(run_statements("string.format(\"%%%-p\", {})"),
            "preset.lua:1: error: string.format: %p is not allowed (addresses differ from run to run)");
  EXPECT_RUNS("assert(string.format(\"%%p %5.1f\", 2.25) == \"%p   2.2\")");
  EXPECT_RUNS("assert(tostring(setmetatable({}, { __tostring = function() return \"me\" end })) == \"me\")");
  EXPECT_EQ(run_statements("tostring(setmetatable({}, { __tostring = function() return 5 end }))"),
            "preset.lua:1: error: tostring: __tostring must return a text");
}

TEST(Sandbox, OrdinaryLuaWorks) {
  EXPECT_RUNS("assert((\"ab\"):rep(2) == \"abab\" and (\"x%d\"):format(3) == \"x3\" and (\"abc\"):sub(2) == \"bc\")");
  EXPECT_RUNS("local t = { 3, 1, 2 } table.sort(t) assert(table.concat(t, \",\") == \"1,2,3\")");
  EXPECT_RUNS(
      "local t = { 3, 1, 2 } table.sort(t, function(a, b) return a > b end) assert(table.concat(t, \",\", 1, 2) == "
      "\"3,2\")");
  EXPECT_RUNS(
      "local t = { 1, 3 } table.insert(t, 2, 2) table.insert(t, 4) assert(#t == 4 and t[2] == 2 and t[3] == 3)");
  EXPECT_RUNS(
      "local t = { 1, 2, 3 } assert(table.remove(t, 1) == 1 and table.remove(t) == 3 and #t == 1 and table.remove({}) "
      "== nil)");
  EXPECT_RUNS("assert(select(\"#\", table.unpack({ 1, 2, 3 })) == 3 and table.pack(1, nil).n == 2)");
  EXPECT_RUNS(
      "assert(tonumber(\"0x10\") == 16 and tonumber(\"z\", 36) == 35 and tonumber(\"\") == nil and tonumber(\"1e2\") "
      "== 100)");
  EXPECT_RUNS("assert(math.floor(2.5) == 2 and math.type(1) == \"integer\" and math.huge > 1)");
  EXPECT_RUNS("local n = 0 for i, v in ipairs({ 5, 6 }) do n = n + i * v end assert(n == 17)");
  EXPECT_EQ(run_statements("table.insert({ 1 }, 3, 1)"),
            "preset.lua:1: error: table.insert: position 3 is out of range; allowed: 1…2");
  EXPECT_EQ(run_statements("table.remove({ 1 }, 3)"),
            "preset.lua:1: error: table.remove: position 3 is out of range; allowed: 1…1");
  EXPECT_EQ(run_statements("table.concat({ 1, {} })"),
            "preset.lua:1: error: table.concat: item 2 is a table; allowed: texts and numbers");
  EXPECT_EQ(run_statements("table.sort(setmetatable({}, {}))"),
            "preset.lua:1: error: table.sort: a table with a metatable cannot be sorted");
}

TEST(Sandbox, CaughtErrorsAreTextsWithTheirPlace) {
  Scene scene;
  scene.preset(R"(
    local function show(f, ...) print(select(2, pcall(f, ...))) end
    show(function() error("mine") end)
    show(function() local x = nil; x() end)
    show(require("afterglow").filters.plus, -1)
    show(error, { 1 })
    show(function() error() end)
    local ok, message = pcall(error, "again", 0)
    assert(pcall(function() return 1 end))
    return require("afterglow").stack {})");
  ASSERT_EQ(scene.load_error(), "");
  EXPECT_THAT(scene.notes, ElementsAre("preset.lua:2: preset.lua:3: mine",
                                       "preset.lua:2: preset.lua:4: attempt to call a nil value (local 'x')",
                                       "preset.lua:2: preset.lua:2: fx.filters.plus: delta = -1 is not a distance",
                                       "preset.lua:2: table", "preset.lua:2: nil"));
}

TEST(Sandbox, ARethrownErrorKeepsItsPlace) {
  EXPECT_EQ(run_statements("local ok, e = pcall(function()\n\n error(\"deep\") end)\n\nerror(e, 0)"),
            "preset.lua:3: error: deep");
  EXPECT_EQ(run_statements("\n\nerror(\"plain\", 0)"), "preset.lua:3: error: plain");
}

TEST(Sandbox, ErrorsThatAreNoTexts) {
  EXPECT_EQ(run_statements("error({ code = 5 })"),
            "preset.lua:1: error: the script raised an error that is a table, not a text");
  EXPECT_EQ(run_statements("\nerror()"), "preset.lua:2: error: the script raised an error that is a nil, not a text");
  EXPECT_EQ(run_statements("error(42)"), "preset.lua:1: error: 42");
  EXPECT_EQ(run_statements("error(setmetatable({}, { __tostring = function() while true do end end }))"),
            "preset.lua:1: error: the script raised an error that is a table, not a text");
}

TEST(Sandbox, LongMessagesAreCut) {
  const std::string message = run_statements("error((\"é\"):rep(100000))");
  EXPECT_EQ(message.substr(0, 23), "preset.lua:1: error: é");
  EXPECT_TRUE(message.ends_with("é…"));  // not cut within a character
  EXPECT_EQ(message.size(), std::string("preset.lua:1: error: ").size() + 400 + 3);
  EXPECT_EQ(run_statements("error(\"a\\27[31m\\0b\")"), "preset.lua:1: error: a [31m b");
}

TEST(Sandbox, PrintIsANoteAndBounded) {
  Scene scene;
  scene.preset(
      "for i = 1, 1000 do print(i, nil, {}) end\nprint((\"x\"):rep(1e6))\nreturn require(\"afterglow\").stack {}");
  ASSERT_EQ(scene.load_error(), "");
  EXPECT_EQ(scene.notes.size(), 100u);
  EXPECT_EQ(scene.notes[0], "preset.lua:1: 1 nil table");
}

// ---- require

TEST(Require, OnlyNamesBesideThePreset) {
  Scene scene;
  scene.write("secret.lua", "return 1");
  const std::string allowed = "; allowed: names joined by '.', like \"lib.taps\"";
  const auto error = [&](const std::string& name) {
    scene.write("inner/preset.lua", "require(" + name + ")");
    ShaderLibrary shaders(search_path_for(scene.folder() / "inner/preset.lua", {}));
    auto preset = Preset::load(scene.folder() / "inner/preset.lua", {}, shaders, scene.diagnostics);
    return preset ? "" : scene.shorten(preset.error().text());
  };
  for (const std::string name :
       {"../secret", "..secret", "/etc/passwd", "a/../../secret", "", ".", "secret.", "a\\\\b", "a\\0b"})
    EXPECT_EQ(error('"' + name + '"').substr(0, 34), "inner/preset.lua:1: error: require") << name;
  EXPECT_EQ(error("\"../secret\""),
            "inner/preset.lua:1: error: require: '../secret' is not the name of a module" + allowed);
  EXPECT_EQ(error("\"secret\""),
            "inner/preset.lua:1: error: require: there is no module 'secret'; allowed: \"afterglow\", and scripts "
            "beside the preset or "
            "on the search path");
  EXPECT_EQ(error("5"), "inner/preset.lua:1: error: require: the name of a module must be a text");
}

TEST(Require, LinksThatLeadOutAreRefused) {
  Scene scene;
  scene.write("secret.lua", "return 1");
  scene.write("inner/near.lua", "return 1");
  std::filesystem::create_symlink(scene.folder() / "secret.lua", scene.folder() / "inner/far.lua");
  std::filesystem::create_symlink(scene.folder() / "inner/near.lua", scene.folder() / "inner/alias.lua");
  std::filesystem::create_directory_symlink(scene.folder(), scene.folder() / "inner/up");
  const auto error = [&](const std::string& name) {
    scene.write("inner/preset.lua", "require \"" + name + "\"\nreturn require(\"afterglow\").stack {}");
    ShaderLibrary shaders(search_path_for(scene.folder() / "inner/preset.lua", {}));
    auto preset = Preset::load(scene.folder() / "inner/preset.lua", {}, shaders, scene.diagnostics);
    return preset ? "" : scene.shorten(preset.error().text());
  };
  const std::string inner = (scene.folder() / "inner").string();
  EXPECT_EQ(error("far"),
            scene.shorten("inner/preset.lua:1: error: require: 'far' is a link that leads out of " + inner));
  EXPECT_EQ(error("up.secret"),
            scene.shorten("inner/preset.lua:1: error: require: 'up.secret' is a link that leads out of " + inner));
  EXPECT_EQ(error("alias"), "");
}

TEST(Require, ModulesRunOnce) {
  Scene scene;
  scene.write("lib/counter.lua", "print(\"loaded\")\nreturn { n = 0 }");
  scene.preset(R"(
    local a, b = require "lib.counter", require "lib.counter"
    a.n = 3
    assert(b.n == 3)
    return require("afterglow").stack {})");
  ASSERT_EQ(scene.load_error(), "");
  EXPECT_THAT(scene.notes, ElementsAre("lib/counter.lua:1: loaded"));
  auto preset = scene.load();
  ASSERT_TRUE(preset);
  std::vector<std::string> files;
  for (const auto& file : preset->scripts()) files.push_back(scene.shorten(file.string()));
  EXPECT_THAT(files, ElementsAre(AFTERGLOW_PROJECT_FOLDER "/scripts/afterglow.lua", "preset.lua", "lib/counter.lua"));
}

TEST(Require, Cycles) {
  Scene scene;
  scene.write("a.lua", "return require \"b\"");
  scene.write("b.lua", "\nreturn require \"a\"");
  scene.preset("require \"a\"");
  EXPECT_EQ(scene.load_error(), "b.lua:2: error: 'a' needs itself while it loads");
}

TEST(Require, NotWhileBuilding) {
  Scene scene;
  scene.write("late.lua", "return 1");
  scene.effect("glow", "build = function(g, s, source)\n require \"late\" return source end,");
  scene.stack("fx.glow {}");
  EXPECT_EQ(
      scene.build_error(),
      "effects/glow.lua:4: error: require: can only be used while a script loads\n  in effect 'glow' of preset.lua:3");
}

}  // namespace
}  // namespace afterglow::test
