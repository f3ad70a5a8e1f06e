// SPDX-License-Identifier: MIT
// Where effects and their shaders are found, and what shadows what.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene.h"

namespace afterglow::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

const std::string kInstalled = AFTERGLOW_PROJECT_FOLDER "/scripts/effects/";

// An effect `tone_mapping` that adds a given name to its pass.
void add_tone_mapping(Scene& scene, const std::string& folder, const std::string& doc) {
  scene.write(folder + "shaders/mine/" + doc + ".glsl", "vec4 apply(vec4 color) { return color; }\n");
  scene.write(folder + "effects/tone_mapping.lua",
              "local fx = require \"afterglow\"\nreturn fx.effect { name = \"tone_mapping\", doc = \"" + doc +
                  "\",\n  build = function(g, s, source) return g:pass { shader = \"mine/" + doc +
                  "\", source = source } end }\n");
}

TEST(Lookup, BuiltInsNeedNothing) {
  Scene scene;
  scene.stack("fx.tone_mapping {}");
  auto preset = scene.load();
  ASSERT_TRUE(preset) << preset.error().text();
  EXPECT_EQ(preset->schema("tone_mapping").file, kInstalled + "tone_mapping.lua");
  EXPECT_THAT(preset->schema("tone_mapping").shadowed, IsEmpty());
  EXPECT_THAT(scene.notes, IsEmpty());
}

TEST(Lookup, AUserEffectWithItsShader) {
  Scene scene;
  scene.write("shaders/invert.glsl",
              "uniform float amount;\nvec4 apply(vec4 color) { return mix(color, 1.0 - color, amount); }\n");
  scene.effect(
      "invert",
      "build = function(g, s, source) return g:pass { shader = \"invert\", source = source, amount = 1 } end,");
  scene.stack("fx.invert {}");
  const Graph graph = scene.graph();
  ASSERT_EQ(graph.passes.size(), 1u);
  EXPECT_EQ(graph.passes[0].name, "invert.invert");
  EXPECT_THAT(scene.notes, IsEmpty());
}

TEST(Lookup, BesideThePresetShadowsABuiltInAndIsReported) {
  Scene scene;
  add_tone_mapping(scene, "", "beside");
  scene.stack("fx.tone_mapping {}");
  auto preset = scene.load();
  ASSERT_TRUE(preset) << preset.error().text();
  EXPECT_EQ(preset->schema("tone_mapping").doc, "beside");
  EXPECT_THAT(preset->schema("tone_mapping").shadowed, ElementsAre(kInstalled + "tone_mapping.lua"));
  EXPECT_THAT(scene.notes, ElementsAre("effect 'tone_mapping' of effects/tone_mapping.lua shadows the built-in " +
                                       kInstalled + "tone_mapping.lua"));
}

TEST(Lookup, PathShadowsABuiltInButNotThePresetsOwn) {
  Scene scene;
  add_tone_mapping(scene, "shared/", "shared");
  scene.options.paths = {scene.folder() / "shared"};
  scene.stack("fx.tone_mapping {}");
  {
    const Graph graph = scene.graph();
    ASSERT_EQ(graph.passes.size(), 1u);
    EXPECT_EQ(graph.passes[0].shader, "mine/shared");
    EXPECT_THAT(scene.notes,
                ElementsAre("effect 'tone_mapping' of shared/effects/tone_mapping.lua shadows the built-in " +
                            kInstalled + "tone_mapping.lua"));
  }
  add_tone_mapping(scene, "", "beside");
  auto preset = scene.load();
  ASSERT_TRUE(preset);
  EXPECT_EQ(preset->schema("tone_mapping").doc, "beside");
  ASSERT_EQ(preset->schema("tone_mapping").shadowed.size(), 2u);
}

TEST(Lookup, ThePathMayNameAFolderTwice) {
  Scene scene;
  scene.effect("mine", "build = function(g, s, source) return source end,");
  scene.options.paths = {scene.folder(), scene.folder() / "."};
  scene.stack("fx.mine {}");
  auto preset = scene.load();
  ASSERT_TRUE(preset);
  EXPECT_THAT(preset->schema("mine").shadowed, IsEmpty());
}

TEST(Lookup, NamesCannotClimbOut) {
  Scene scene;
  scene.write("evil.lua", "return 1");
  scene.stack("fx[\"../evil\"] {}");
  EXPECT_EQ(scene.load_error().substr(0, 46), "preset.lua:3: error: unknown effect '../evil';");
  scene.stack("fx[5] {}");
  EXPECT_EQ(scene.load_error(), "preset.lua:3: error: fx: the name of an effect must be a text");
}

TEST(Lookup, LinkedEffectsMayNotLeadOut) {
  Scene scene, other;
  other.effect("far", "build = function(g, s, source) return source end,");
  scene.write("effects/.keep", "");
  std::filesystem::create_symlink(other.folder() / "effects/far.lua", scene.folder() / "effects/far.lua");
  scene.stack("fx.far {}");
  EXPECT_EQ(scene.load_error(),
            "preset.lua:3: error: effect 'far' is a link that leads out of " + scene.folder().string());
}

TEST(Lookup, AnInstallationThatIsMissing) {
  Scene scene;
  scene.stack("");
  setenv("AFTERGLOW_HOME", scene.folder().c_str(), 1);
  const std::string error = scene.load_error();
  unsetenv("AFTERGLOW_HOME");
  EXPECT_EQ(error, "scripts/afterglow.lua: error: no such file");
}

TEST(ListEffects, AllOfThePathByName) {
  Scene scene;
  scene.effect("mine", "doc = \"Mine.\", build = function(g, s, source) return source end,");
  scene.effect("broken", "odrer = 1, build = function(g, s, source) return source end,");
  scene.write("effects/not an effect.lua", "");
  scene.write("effects/notes.txt", "");
  SearchPath path;
  path.user = {scene.folder()};
  path.installation = AFTERGLOW_PROJECT_FOLDER;
  const auto effects = list_effects(path, scene.diagnostics);
  ASSERT_TRUE(effects) << effects.error().text();
  std::vector<std::string> names;
  for (const auto& effect : *effects) names.push_back(effect.name);
  EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
  EXPECT_THAT(names, testing::Contains("mine"));
  EXPECT_THAT(names, testing::Contains("tone_mapping"));
  EXPECT_THAT(names, testing::Not(testing::Contains("broken")));
  EXPECT_THAT(
      scene.warnings,
      ElementsAre("effects/not an effect.lua is left out: the name of an effect has letters, digits and '_' alone",
                  "effect 'broken' is left out: effects/broken.lua:3: error: fx.effect has no "
                  "'odrer'; allowed: active, alpha, at, build, "
                  "detail, doc, holds, idle, name, needs, optional, order, settings, space; did you mean 'order'?"));
}

// The names that no effect may have are those that the library has.
TEST(ListEffects, NamesOfTheLibraryAreReserved) {
  Scene scene;
  scene.preset(R"(
    local fx, names = require "afterglow", {}
    for name in pairs(fx) do names[#names + 1] = name end
    print(table.concat(names, " "))
    return fx.stack {})");
  ASSERT_EQ(scene.load_error(), "");
  EXPECT_THAT(scene.notes, ElementsAre("preset.lua:4: args bool color curve effect enum extend file filters float "
                                       "group int mask mix stack text vec2 vec3 volume"));
}

// Every effect of the installation, as the design's table has it, can be listed without a complaint.
TEST(ListEffects, TheInstallationIsSound) {
  Scene scene;
  SearchPath path;
  path.installation = AFTERGLOW_PROJECT_FOLDER;
  const auto effects = list_effects(path, scene.diagnostics);
  ASSERT_TRUE(effects);
  EXPECT_THAT(scene.warnings, IsEmpty());
  for (const auto& effect : *effects) {
    EXPECT_FALSE(effect.doc.empty()) << effect.name;
    for (const auto& setting : effect.settings) EXPECT_FALSE(setting.doc.empty()) << effect.name << "." << setting.name;
  }
}

}  // namespace
}  // namespace afterglow::test
