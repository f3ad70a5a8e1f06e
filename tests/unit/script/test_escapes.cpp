// SPDX-License-Identifier: MIT
// Ways out of a sandbox that are known of Lua and of those who embed it, one test each; test_sandbox.cpp and
// test_limits.cpp hold those that were tried before. The clock's limit is far away: what ends is ended by a count.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene.h"

namespace afterglow::test {
namespace fs = std::filesystem;
namespace {

using testing::AnyOf;
using testing::HasSubstr;

// Statements of a preset that has `fx`; its error, "" when it loads.
std::string escape(const std::string& statements) {
  Scene scene;
  scene.options.limits = {16u << 20, 2'000'000, 60};
  scene.preset("local fx = require \"afterglow\"\n" + statements + "\nreturn fx.stack {}\n");
  return scene.load_error();
}

// The body of an effect's `build`; the error of building.
std::string build(const std::string& statements, const std::string& settings = "") {
  Scene scene;
  scene.options.limits = {16u << 20, 2'000'000, 60};
  scene.effect(
      "glow", "settings = {" + settings + "},\nbuild = function(g, s, source)\n" + statements + "\nreturn source end,");
  scene.write("shaders/glow/mix.glsl",
              "uniform float strength;\nvec4 apply(vec4 color) { return color * strength; }\n");
  scene.stack("fx.glow {}");
  return scene.build_error();
}

const std::string kBudget = "error: instruction budget spent: more than 2000000 instructions or 60 s";
const std::string kMemory = "preset.lua:2: error: memory limit reached: more than 16 MiB";

// ---- loops of Lua's own that no hook interrupts

TEST(Escapes, NothingRepeatedForEver) {
  EXPECT_EQ(escape("assert((\"\"):rep(math.maxinteger) == \"\")"), "");
  EXPECT_EQ(escape("assert(string.rep(\"\", 2^53, \"\") == \"\")"), "");
  EXPECT_EQ(
      escape(
          "assert((\"\"):rep(3, \",\") == \",,\" and (\"ab\"):rep(2, \"-\") == \"ab-ab\" and (\"x\"):rep(-1) == \"\")"),
      "");
  EXPECT_EQ(escape("local s = (\"\"):rep(1e9, \",\")"), kMemory);
  EXPECT_THAT(escape("local s = (\"x\"):rep(math.maxinteger)"),
              AnyOf(kMemory, HasSubstr("resulting string too large")));
}

TEST(Escapes, TablesThatCallThemselves) {
  const std::string refused = "preset.lua:2: error: setmetatable: __call must be a function";
  EXPECT_EQ(escape("local m = {} local t = setmetatable({}, m) m.__call = t m.__call = t setmetatable(t, m) t()"),
            refused);
  EXPECT_EQ(escape("local t = {} setmetatable(t, { __call = t }) t()"), refused);
  // Later changes of the metatable do not count, so that no chain can be closed behind the check's back.
  EXPECT_EQ(escape("local m = {} local t = setmetatable({}, m) m.__call = t t()"),
            "preset.lua:2: error: attempt to call a table value (local 't')");
  EXPECT_EQ(escape("local m = { __call = function(t, x) return x + 1 end } assert(setmetatable({}, m)(2) == 3)"), "");
  EXPECT_EQ(escape("local t = setmetatable({}, { __call = pcall }) t()"), "");  // through C, which counts its depth
}

TEST(Escapes, WeakTablesAndFinalizers) {
  EXPECT_THAT(escape("setmetatable({}, { __mode = \"k\" })"), HasSubstr("__mode is not allowed"));
  EXPECT_THAT(escape("setmetatable({}, { __gc = true })"), HasSubstr("__gc is not allowed"));
  EXPECT_EQ(escape("local ran = false local m = {} do local t = setmetatable({}, m) end\n"
                   "m.__gc = function() ran = true end m.__mode = \"k\"\n"
                   "for i = 1, 200 do local waste = (\"x\"):rep(100000) end assert(not ran)"),
            "");
  EXPECT_THAT(
      escape(
          "setmetatable({}, setmetatable({}, { __index = function(t, k) return k == \"__gc\" and print or nil end }))"),
      "");
}

TEST(Escapes, LongTextsInOneInstruction) {
  // One conversion of 8 MB of digits takes longer than thousands of instructions; the clock gets its turn between them.
  Scene scene;
  scene.options.limits = {64u << 20, ~0ull, 0.3};
  scene.preset("local s = (\"1\"):rep(8e6) while true do local x = s + 0 end");
  EXPECT_THAT(scene.load_error(), HasSubstr("instruction budget spent"));
}

// ---- metatables

TEST(Escapes, MetatablesStayWhatTheyWere) {
  EXPECT_EQ(
      escape("local m = {} local t = setmetatable({}, m) assert(getmetatable(t) == m and setmetatable(t, nil) == t "
             "and getmetatable(t) == nil)"),
      "");
  EXPECT_EQ(
      escape("local C = {} C.__index = C function C.new() return setmetatable({}, C) end local c = C.new() function "
             "C:late() return 7 end assert(c:late() == 7)"),
      "");
  EXPECT_EQ(escape("local t = setmetatable({}, { __metatable = \"mine\" }) assert(getmetatable(t) == \"mine\") "
                   "setmetatable(t, nil)"),
            "preset.lua:2: error: setmetatable: this metatable is protected");
  EXPECT_EQ(escape("local t = setmetatable({}, {}) rawset(t, 1, 2) table.insert(t, 3) assert(#t == 2)"), "");
  EXPECT_EQ(escape("local t = setmetatable({}, { __eq = function() return true end, __lt = function() return true end, "
                   "__concat = "
                   "function() return \"c\" end, __len = function() return 9 end }) assert(t == setmetatable({}, "
                   "getmetatable(t)) and "
                   "t < t and t .. 1 == \"c\" and #t == 9)"),
            "");
}

TEST(Escapes, TheTableOfGlobalsIsOutOfReach) {
  EXPECT_EQ(escape("assert(getmetatable(_ENV) == false)"), "");
  EXPECT_EQ(escape("setmetatable(_ENV, {})"), "preset.lua:2: error: setmetatable: this metatable is protected");
  EXPECT_EQ(escape("local _ENV = {} x = 1"), "");
  EXPECT_THAT(escape("getmetatable(\"\").__index = print"), HasSubstr("attempt to index a boolean value"));
  EXPECT_EQ(escape("string = { format = print } assert((\"%d\"):format(1) == \"1\")"), "");
  EXPECT_EQ(escape("require = nil pcall = nil"), "");
}

TEST(Escapes, MetamethodsOfWhatIsHandedToUs) {
  // Tables are read as they are: nothing that they pretend is believed, nothing of theirs is called.
  const std::string trap =
      "local function trap() while true do end end\nlocal m = { __index = trap, __len = trap, __pairs = trap, "
      "__newindex = trap, __tostring = trap, __eq = trap, __close = trap }\n";
  EXPECT_EQ(escape(trap + "fx.stack(setmetatable({}, m))"), "");
  EXPECT_EQ(escape(trap + "fx.stack { setmetatable({}, m) }"), "");  // a list of effects, without any
  EXPECT_EQ(escape(trap + "fx.stack { name = setmetatable({}, m) }").substr(0, 20), "preset.lua:4: error:");
  EXPECT_EQ(escape(trap + "fx.bloom(setmetatable({ intensity = setmetatable({}, m) }, m))").substr(0, 20),
            "preset.lua:4: error:");
  EXPECT_EQ(escape(trap + "fx.color { default = setmetatable({ 1, 1, 1 }, m), doc = \"d\" }"), "");
  EXPECT_EQ(escape(trap + "table.concat(setmetatable({ 1 }, m))"), "");
  EXPECT_EQ(escape(trap + "for k in pairs(setmetatable({}, m)) do end"), "");
  EXPECT_EQ(escape(trap + "error(setmetatable({}, m))"),
            "preset.lua:4: error: the script raised an error that is a table, not a text");
}

// ---- texts, C stack, error objects

TEST(Escapes, DepthInEveryLanguage) {
  EXPECT_EQ(escape("local t = {} for i = 1, 1e5 do t = { t } end fx.stack(t)").substr(0, 20), "preset.lua:2: error:");
  EXPECT_EQ(escape("local t = {} for i = 1, 1e5 do t = { default = t } end fx.float(t)").substr(0, 20),
            "preset.lua:2: error:");
  EXPECT_EQ(escape("local m = {} m.__tostring = function(t) return tostring(t) end tostring(setmetatable({}, m))"),
            "preset.lua:2: error: C stack overflow");
  EXPECT_EQ(escape("local m = {} m.__index = function(t, k) return t[k] end m.__newindex = m.__index local x = "
                   "setmetatable({}, m).y"),
            "preset.lua:2: error: C stack overflow");
  EXPECT_EQ(
      escape(
          "local m = {} m.__concat = function(a, b) return a .. b end local t = setmetatable({}, m) local x = t .. t"),
      "preset.lua:2: error: C stack overflow");
  EXPECT_EQ(
      escape(
          "local t = {} for i = 1, 3000 do t[i] = i end table.sort(t, function(a, b) table.sort(t) return a < b end)")
          .substr(0, 20),
      "preset.lua:2: error:");
}

TEST(Escapes, ErrorsFromHandlers) {
  EXPECT_EQ(escape("local function f() error(setmetatable({}, { __tostring = error })) end assert(not pcall(f)) "
                   "pcall(pcall, f) pcall(error)"),
            "");
  EXPECT_EQ(escape("local x <close> = setmetatable({}, { __close = function() while true do end end }) error(\"x\")"),
            "preset.lua:2: " + kBudget);
  EXPECT_EQ(escape("while true do pcall(error, setmetatable({}, { __tostring = error })) end"),
            "preset.lua:2: " + kBudget);
  EXPECT_EQ(escape("for i = 1, 200 do local ok = pcall(pcall, pcall, error) end pcall(string.rep, \"x\", 1e9)"),
            kMemory);
}

TEST(Escapes, ManyValuesAtOnce) {
  EXPECT_THAT(escape("table.unpack({}, 1, 1e8)"), HasSubstr("too many results to unpack"));
  EXPECT_THAT(escape("string.byte((\"x\"):rep(2e6), 1, -1)"), HasSubstr("string slice too long"));
  EXPECT_THAT(escape("select(-math.maxinteger, 1)"), HasSubstr("index out of range"));
  EXPECT_THAT(escape("string.char(table.unpack({}, 1, 10))"), HasSubstr("number expected, got nil"));
  EXPECT_EQ(escape("while true do select(\"#\", table.unpack({}, 1, 1e5)) end"), "preset.lua:2: " + kBudget);
  EXPECT_EQ(escape("local t = { 1, 2, 3 } local a, b = table.unpack(t, 2) assert(a == 2 and b == 3 and select(\"#\", "
                   "table.unpack(t, 3, 2)) == 0)"),
            "");
  EXPECT_THAT(escape("table.unpack({}, math.mininteger, math.maxinteger)"), HasSubstr("too many results to unpack"));
}

// ---- numbers that are none

TEST(Escapes, NumbersThatNoCountCanBe) {
  for (const char* number : {"0/0", "1/0", "-1/0", "2^53", "-2^53", "math.mininteger", "1e308"}) {
    SCOPED_TRACE(number);
    EXPECT_THAT(escape(std::string("fx.bloom { max_iterations = ") + number + " }"),
                HasSubstr("preset.lua:2: error: "));
    EXPECT_THAT(escape(std::string("fx.bloom { scatter = ") + number + " }"), HasSubstr("preset.lua:2: error: "));
    EXPECT_THAT(build(std::string("g:pass { shader = \"glow/mix\", source = source, strength = 1, size = { ") + number +
                      ", 4 } }"),
                HasSubstr("effects/glow.lua:5: error: "));
    EXPECT_THAT(
        build(std::string("g:pass { shader = \"glow/mix\", source = source, strength = 1, reach = ") + number + " }"),
        AnyOf(HasSubstr("effects/glow.lua:5: error: "), testing::IsEmpty()));
    EXPECT_THAT(build(std::string("g:history { first = source, pre_roll = ") + number + " }"),
                HasSubstr("effects/glow.lua:5: error: "));
    EXPECT_THAT(
        build(std::string("g:filter { source = source, size = { 4, 4 }, filter = fx.filters.plus(") + number + ") }"),
        HasSubstr("error: "));
  }
  for (const char* number : {"0/0", "1/0", "-1/0"})
    EXPECT_THAT(escape(std::string("fx.curve { { 0, 1 }, { ") + number + ", 1 } }"), HasSubstr("preset.lua:2: error: "))
        << number;
  for (const char* number : {"0/0", "1/0", "1e39"})  // more than a 32-bit float holds
    EXPECT_THAT(build(std::string("g:pass { shader = \"glow/mix\", source = source, strength = ") + number + " }"),
                HasSubstr("effects/glow.lua:5: error: "))
        << number;
}

TEST(Escapes, PassesWithoutEnd) {
  EXPECT_THAT(build("for i = 1, 1e9 do source = g:pass { shader = \"glow/mix\", source = source, strength = 1 } end"),
              AnyOf(HasSubstr("passes"), HasSubstr(kBudget)));
  EXPECT_THAT(build("for i = 1, 1e9 do g:history { first = source } end"), HasSubstr("error: "));
  EXPECT_THAT(build("for i = 1, 1e9 do pcall(g.pass, g, {}) end"), HasSubstr(kBudget));
  EXPECT_THAT(build("local t = {} for i = 1, 1e5 do t[i] = { i, 1 } end g:filter { source = source, size = { 4, 4 }, "
                    "filter = { x = t } }"),
              HasSubstr("error: "));
}

TEST(Escapes, ThingsOfAnEarlierBuild) {
  Scene scene;
  scene.effect("glow",
               "build = function(g, s, source) kept = rawget(_ENV, \"kept\") or { g, source } return kept[2] end,");
  scene.stack("fx.glow {}");
  auto preset = scene.load();
  ASSERT_TRUE(preset);
  ASSERT_TRUE(scene.build(*preset));
  const auto second = scene.build(*preset);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().kind, ErrorKind::script);
}

// ---- what one preset does to another

TEST(Escapes, PresetsOfOneProcessShareNothing) {
  Scene first, second;
  for (Scene* scene : {&first, &second}) scene->write("lib/shared.lua", "return { n = 0, list = {} }");
  first.preset(
      "local shared = require \"lib.shared\" shared.n = 5 shared.list[1] = 1 leak = 7 string = nil math = nil\n"
      "assert(not pcall(function() require(\"afterglow\").stack = nil end))\nreturn require(\"afterglow\").stack {}");
  second.preset(
      "local shared = require \"lib.shared\" assert(shared.n == 0 and #shared.list == 0 and rawget(_ENV, \"leak\") == "
      "nil and string and "
      "math)\n"
      "return require(\"afterglow\").stack {}");
  auto one = first.load();
  ASSERT_TRUE(one) << one.error().text();
  EXPECT_EQ(second.load_error(), "");
  auto again = first.load();
  ASSERT_TRUE(again) << again.error().text();
}

TEST(Escapes, ModulesOfOneFolderAreNotThoseOfAnother) {
  Scene scene, pack;
  scene.options.paths = {pack.folder()};
  const auto effect = [](Scene& in, const std::string& name, const std::string& check) {
    in.effect(name, "doc = assert(" + check + ") and \"Mine.\", build = function(g, s, source) return source end");
  };
  const std::string preset =
      "local own = require \"lib.taps\" assert(own.of == \"preset\" and own == require \"lib.taps\")\n"
      "local fx = require \"afterglow\" return fx.stack { fx.mine {}, fx.theirs {}, fx.halation {}, fx.depth_fog {} }";
  scene.preset(preset);
  scene.write("lib/taps.lua", "return { of = \"preset\" }");
  scene.write("lib/glow.lua", "return { of = \"preset\" }");
  pack.write("lib/taps.lua", "return { of = \"pack\" }");
  effect(scene, "mine", R"(require("lib.taps").of == "preset" and require("lib.glow").of == "preset")");
  effect(pack, "theirs", R"(require("lib.taps").of == "pack" and require("lib.pyramid").delivered)");
  scene.context.auxiliary = {{"depth", {64, 32}}};
  EXPECT_EQ(scene.build_error(), "") << "built-in effects have the built-in lib.glow";
  // A folder without such a module gets that of the first on the path.
  fs::remove(pack.folder() / "lib/taps.lua");
  effect(pack, "theirs", R"(require("lib.taps").of == "preset")");
  EXPECT_EQ(scene.build_error(), "");
}

TEST(Escapes, ModulesThatAreNotThereOrReturnNothing) {
  Scene scene;
  scene.write("lib/taps.lua", "local taps = {}\n");
  scene.preset("local taps = require \"lib.tpas\"");
  EXPECT_THAT(scene.load_error(), HasSubstr("there is no module 'lib.tpas'; allowed: \"afterglow\", and scripts beside "
                                            "the preset or on the search path; did you mean 'lib.taps'?"));
  scene.preset("local taps = require \"lib.taps\"\nlocal n = taps.gaussian(3)");
  EXPECT_THAT(scene.load_error(), HasSubstr("preset.lua:2: error: the module "));
  EXPECT_THAT(scene.load_error(), HasSubstr("lib/taps.lua returns nothing; allowed: a return at its end"));
  scene.preset("assert(require \"lib.taps\") return require(\"afterglow\").stack {}");
  EXPECT_EQ(scene.load_error(), "") << "one that only does something may be required";
}

TEST(Escapes, AModuleRunsOnceWhoeverNeedsIt) {
  Scene scene;
  scene.write("lib/shared.lua", "return {}");
  scene.write("lib/other.lua", "return { shared = require \"lib.shared\" }");
  scene.effect("glow", "build = function(g, s, source) return source end, doc = require(\"lib.shared\").doc");
  scene.preset(
      "local shared = require \"lib.shared\" shared.doc = \"Seen.\" assert(require(\"lib.other\").shared == shared)\n"
      "local fx = require \"afterglow\" return fx.stack { fx.glow {} }");
  auto preset = scene.load();
  ASSERT_TRUE(preset) << preset.error().text();
  EXPECT_EQ(preset->schema("glow").doc, "Seen.");
  scene.write("lib/shared.lua", "return require \"lib.shared\"");
  EXPECT_THAT(scene.load_error(), HasSubstr("'lib.shared' needs itself while it loads"));
}

// ---- files

TEST(Escapes, NamesWithZeros) {
  Scene scene;
  scene.write("lib.lua", "return 1");
  scene.effect("glow", "build = function(g, s, source) return source end,");
  scene.preset("require \"lib\\0/../secret\"");
  EXPECT_THAT(scene.load_error(), HasSubstr("is not the name of a module"));
  scene.preset("require \"afterglow\\0x\"");
  EXPECT_THAT(scene.load_error(), HasSubstr("is not the name of a module"));
  scene.preset("local f = require(\"afterglow\")[\"glow\\0x\"]");
  EXPECT_THAT(scene.load_error(), HasSubstr("unknown effect 'glow x'"));
}

TEST(Escapes, RequireFindsNoWayOut) {
  Scene scene;
  scene.write("../afterglow_secret.lua", "return 1");
  for (const char* name : {"../afterglow_secret", "..afterglow_secret", "/etc/passwd", "lib/../../x", "a\\\\b", ".", "",
                           "..", "~/x", "C:\\\\x", "lib..x", "-", "x.lua"}) {
    scene.preset(std::string("require \"") + name + "\"");
    EXPECT_THAT(scene.load_error(), AnyOf(HasSubstr("is not the name of a module"), HasSubstr("there is no module")))
        << name;
  }
  std::filesystem::remove(scene.folder().parent_path() / "afterglow_secret.lua");
}

TEST(Escapes, ShadersFindNoWayOutEither) {
  Scene outside, scene;
  const auto secret = outside.write("secret.glsl", "vec4 apply(vec4 color) { return color; }\n");
  const std::string lines =
      "build = function(g, s, source) return g:pass { shader = \"glow/mix\", source = source } end,";
  scene.effect("glow", lines);
  scene.stack("fx.glow {}");
  scene.write("shaders/glow/other.glsl", "vec4 apply(vec4 color) { return color; }\n");
  std::filesystem::create_symlink(secret, scene.folder() / "shaders/glow/mix.glsl");
  EXPECT_THAT(scene.build_error(), HasSubstr("is a link that leads out of"));
  std::filesystem::remove(scene.folder() / "shaders/glow/mix.glsl");
  std::filesystem::create_symlink(scene.folder() / "shaders/glow/other.glsl", scene.folder() / "shaders/glow/mix.glsl");
  EXPECT_EQ(scene.build_error(), "");
  std::filesystem::remove(scene.folder() / "shaders/glow/mix.glsl");
  std::filesystem::create_symlink(secret, scene.folder() / "shaders/glow/part.glsl");
  scene.write("shaders/glow/mix.glsl", "#include \"part.glsl\"\nvec4 apply(vec4 color) { return color; }\n");
  EXPECT_THAT(scene.build_error(), HasSubstr("is a link that leads out of"));
  for (const char* name : {"../../secret", "/etc/passwd", "glow/../../x", "glow\\0/mix"}) {
    scene.effect("glow", std::string("build = function(g, s, source) return g:pass { shader = \"") + name +
                             "\", source = source } end,");
    EXPECT_THAT(scene.build_error(), HasSubstr("unknown shader")) << name;
  }
}

TEST(Escapes, ManyLargeScripts) {
  // Their texts lie outside of Lua's memory: 20 of 1 MiB are more than a preset may have.
  Scene scene;
  std::string preset;
  for (int i = 0; i < 20; ++i) {
    scene.write("m" + std::to_string(i) + ".lua", "--" + std::string((1u << 20) - 64, 'x') + "\nreturn 1");
    preset += "require \"m" + std::to_string(i) + "\"\n";
  }
  scene.preset(preset);
  EXPECT_THAT(scene.load_error(), HasSubstr("the scripts of this preset have more than 16 MiB together"));
}

}  // namespace
}  // namespace afterglow::test
