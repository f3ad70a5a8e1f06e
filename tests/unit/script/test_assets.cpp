// SPDX-License-Identifier: MIT
// Files that effects read: the setting type, where a name is looked up, and where it never leads.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "scene.h"

namespace afterglow {
namespace {
namespace fs = std::filesystem;
using test::Scene;
using testing::HasSubstr;

const std::string kTable = "LUT_1D_SIZE 2\n0 0 0\n1 1 1\n";

class Assets : public testing::Test {
 protected:
  void SetUp() override {
    scene.effect("tint", R"(
      settings = { table = fx.file { extensions = { "cube" }, doc = "The table." } },
      active = function(s) return s.table ~= "", "table is not given" end,
      build = function(g, s, source)
        return g:pass { shader = "tint/apply", source = source, numbers = g:lookup { file = s.table }.table }
      end,)");
    scene.write("shaders/tint/apply.glsl",
                "uniform sampler2D numbers;\nvec4 apply(vec4 color) { return color + fetch(numbers, ivec2(0)); }\n");
  }
  /// The file that the graph's data comes from, without the scene's folder; or the error.
  std::string found() {
    auto preset = scene.load();
    if (!preset) return scene.shorten(preset.error().text());
    auto graph = scene.build(*preset);
    if (!graph) return scene.shorten(graph.error().text());
    for (const auto& image : graph->images)
      if (image.data) return scene.shorten(image.data->file.string());
    return "nothing";
  }
  Scene scene;
};

TEST_F(Assets, BesideThePreset) {
  scene.write("a.cube", kTable);
  scene.write("luts/b.cube", kTable);
  scene.stack("fx.tint { table = \"a.cube\" }");
  EXPECT_EQ(found(), "a.cube");
  scene.stack("fx.tint { table = \"luts/b.cube\" }");
  EXPECT_EQ(found(), "luts/b.cube");
  scene.stack("fx.tint {}");
  EXPECT_EQ(found(), "nothing");
}

TEST_F(Assets, AlongTheSearchPathAndInPacks) {
  scene.write("packs/glow/c.cube", kTable);
  scene.write("other/d.cube", kTable);
  scene.write("other/a.cube", kTable);
  scene.write("a.cube", kTable);
  scene.options.paths = {scene.folder() / "other"};
  scene.stack("fx.tint { table = \"c.cube\" }");
  EXPECT_EQ(found(), "packs/glow/c.cube");
  scene.stack("fx.tint { table = \"d.cube\" }");
  EXPECT_EQ(found(), "other/d.cube");
  scene.stack("fx.tint { table = \"a.cube\" }");
  EXPECT_EQ(found(), "a.cube");
}

TEST_F(Assets, NamesThatLeadOut) {
  const fs::path outside = fs::temp_directory_path() / ("afterglow_outside_" + std::to_string(getpid()) + ".cube");
  std::ofstream(outside) << kTable;
  for (const std::string& name :
       {std::string("../") + outside.filename().string(), outside.string(), std::string("x/../a.cube")}) {
    scene.stack("fx.tint { table = [[" + name + "]] }");
    EXPECT_THAT(found(), HasSubstr("preset.lua:3: error: tint.table = ")) << name;
    EXPECT_THAT(found(), HasSubstr("is not a name inside")) << name;
  }
  for (const std::string name : {"./a.cube", "lut\\a.cube", "lut//a.cube"}) {
    scene.stack("fx.tint { table = [[" + name + "]] }");
    EXPECT_THAT(found(), HasSubstr("is not how scripts name a file")) << name;
    EXPECT_THAT(found(), HasSubstr(name[0] == '.' ? "did you mean 'a.cube'?" : "did you mean 'lut/a.cube'?"));
  }
  // A script that builds the name itself gets no further.
  scene.effect("reach",
               "build = function(g, s, source) g:lookup { file = \"" + outside.string() + "\" } return source end,");
  scene.stack("fx.reach {}");
  EXPECT_THAT(found(), HasSubstr("leads out of the folders that scripts may read"));
  fs::create_symlink(outside, scene.folder() / "link.cube");
  scene.stack("fx.tint { table = \"link.cube\" }");
  EXPECT_THAT(found(), HasSubstr("preset.lua:3: error: table = \"link.cube\": is a link that leads out of"));
  fs::create_directory_symlink(outside.parent_path(), scene.folder() / "folder");
  scene.stack("fx.tint { table = \"folder/" + outside.filename().string() + "\" }");
  EXPECT_THAT(found(), HasSubstr("is a link that leads out of"));
  fs::remove(outside);
}

TEST_F(Assets, TheCommandLineMayNameAnyFile) {
  const fs::path outside = fs::temp_directory_path() / ("afterglow_given_" + std::to_string(getpid()) + ".cube");
  std::ofstream(outside) << kTable;
  scene.stack("fx.tint {}");
  scene.options.overrides = {{"tint", "table", outside.string()}};
  EXPECT_EQ(found(), outside.string());
  fs::remove(outside);
  EXPECT_THAT(found(), HasSubstr("there is no such file"));
}

TEST_F(Assets, FilesAreKnownOnceBuilt) {
  const auto file = scene.write("a.cube", kTable);
  scene.stack("fx.tint { table = \"a.cube\" }");
  auto preset = scene.load();
  ASSERT_TRUE(preset);
  const auto built = scene.evaluate(*preset);
  ASSERT_TRUE(built) << built.error().text();
  EXPECT_TRUE(built->depends.files.contains(file));
  // Every build of a preset sees the same; another preset sees what the file holds then.
  const auto graph = scene.build(*preset).value();
  scene.write("a.cube", "LUT_1D_SIZE 2\n0 0 0\n1 1 0.5\n");
  const auto table_of = [](const Graph& of) {
    for (const auto& image : of.images)
      if (image.data) return image.data->hash;
    return Hash{};
  };
  EXPECT_EQ(table_of(graph), table_of(scene.build(*preset).value()));
  auto again = scene.load();
  ASSERT_TRUE(again);
  const Graph later = scene.build(*again).value();
  EXPECT_NE(table_of(graph), table_of(later));
  EXPECT_TRUE(same_structure(graph, later)) << "the same program can read both";
}

TEST_F(Assets, Messages) {
  scene.write("film.cube", kTable);
  scene.stack("fx.tint {\n  table = \"flim.cube\" }");
  EXPECT_THAT(found(), HasSubstr("preset.lua:4: error: table = \"flim.cube\": there is no such file"));
  EXPECT_THAT(found(), HasSubstr("did you mean 'film.cube'?"));
  scene.stack("fx.tint { table = \"film.png\" }");
  EXPECT_THAT(found(), HasSubstr("no file of a kind that is allowed"));
  scene.stack("fx.tint { table = 3 }");
  EXPECT_THAT(found(), HasSubstr("not the name of a file"));
  scene.stack("fx.tint { table = fx.curve { { 0, \"a.cube\" }, { 9, \"film.cube\" } } }");
  EXPECT_THAT(found(), HasSubstr("cannot be a curve"));
  scene.write("film.cube", "LUT_1D_SIZE 2\n0 0 0\n1 1\n");
  scene.stack("fx.tint { table = \"film.cube\" }");
  EXPECT_THAT(found(), HasSubstr("film.cube:3: error: a colour has 3 numbers, not 2"));
  scene.effect("tint",
               "settings = { table = fx.file { doc = \"x\" } }, build = function(g, s, source) return source end");
  EXPECT_THAT(found(), HasSubstr("fx.file needs extensions"));
  scene.effect("tint",
               "settings = { table = fx.file { extensions = { \".cube\" } } }, build = function(g, s, source) return "
               "source end");
  EXPECT_THAT(found(), HasSubstr("without the point"));
}

/// g:image { pixels = … }: palettes, curves and weights that a script makes.
class Pixels : public testing::Test {
 protected:
  /// The image of this call, or what is wrong with it.
  std::string made(const std::string& arguments) {
    scene.effect("painted",
                 "build = function(g, s, source)\n  return g:pass { shader = \"tint/apply\", source = source, "
                 "numbers = g:image {\n" +
                     arguments + "\n} }\nend");
    scene.write("shaders/tint/apply.glsl",
                "uniform sampler2D numbers;\nvec4 apply(vec4 color) { return color + fetch(numbers, ivec2(0)); }\n");
    scene.stack("fx.painted {}");
    auto preset = scene.load();
    if (!preset) return scene.shorten(preset.error().text());
    auto graph = scene.build(*preset);
    if (!graph) return scene.shorten(graph.error().text());
    for (const auto& image : graph->images)
      if (image.data) data = image.data;
    return fmt::format("{}x{}", data->size.width, data->size.height);
  }
  Scene scene;
  std::shared_ptr<const ImageData> data;
};

TEST_F(Pixels, AreNumbersOrLists) {
  ASSERT_EQ(made("pixels = { 0.5, { 1, 2, 3 }, { 4, 5, 6, 0.25 }, { 7 } }"), "4x1");
  EXPECT_EQ(data->pixels, (std::vector<float>{0.5f, 0.5f, 0.5f, 1, 1, 2, 3, 1, 4, 5, 6, 0.25f, 7, 0, 0, 1}));
  ASSERT_EQ(made("pixels = { 1, 2, 3, 4, 5, -1e9 }, width = 2"), "2x3");
  EXPECT_EQ(data->pixels[20], -1e9f);
  const Hash first = data->hash;
  ASSERT_EQ(made("pixels = { 1, 2, 3, 4, 5, -1e9 }, width = 2"), "2x3");
  EXPECT_EQ(data->hash, first);
  ASSERT_EQ(made("pixels = { 1, 2, 3, 4, 5, -1e9 }, width = 3"), "3x2");
  EXPECT_NE(data->hash, first);
}

TEST_F(Pixels, Messages) {
  EXPECT_THAT(made("pixels = {}"), HasSubstr("effects/painted.lua:5: error: effect 'painted': g:image: pixels = "));
  EXPECT_THAT(made("pixels = {}"), HasSubstr("a list of 1 to 65536 pixels"));
  EXPECT_THAT(made("pixels = 3"), HasSubstr("a list of 1 to 65536 pixels"));
  EXPECT_THAT(made("pixels = { 1, \"red\" }"), HasSubstr("pixel 2 is \"red\"; allowed: a number, 1 to 4 numbers"));
  EXPECT_THAT(made("pixels = { 1, 0/0 }"), HasSubstr("pixel 2 is not finite"));
  EXPECT_THAT(made("pixels = { 1, 1e300 }"), HasSubstr("pixel 2 is not finite"));
  EXPECT_THAT(made("pixels = { 1, 2, 3 }, width = 2"), HasSubstr("3 pixels are no whole rows of 2"));
  EXPECT_THAT(made("pixels = { 1, 2, 3 }, width = 0"), HasSubstr("no whole rows of 0"));
  EXPECT_THAT(made("pixels = { 1 }, file = \"a.png\""), HasSubstr("'file' does not go with 'pixels'"));
  EXPECT_THAT(made("pixel = { 1 }"), HasSubstr("did you mean 'pixels'?"));
}

}  // namespace
}  // namespace afterglow
