// SPDX-License-Identifier: MIT
// Configurations of OpenColorIO that effects name: where they may lie, what is wrong with them, and what is noticed
// when they change.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "core/file_record.h"
#include "scene.h"

namespace afterglow {
namespace {
namespace fs = std::filesystem;
using test::Scene;
using testing::HasSubstr;
using testing::Not;

const std::string kCurve = "Version 1\nFrom 0 1\nLength 2\nComponents 1\n{\n0\n1\n}\n";

std::string config_of(const std::string& film, const std::string& more = "") {
  return "ocio_profile_version: 2\nsearch_path: tables\nroles: {default: lin_rec709, scene_linear: lin_rec709}\n"
         "file_rules: [!<Rule> {name: Default, colorspace: lin_rec709}]\n"
         "displays:\n  Monitor:\n    - !<View> {name: Film, colorspace: film}\n    - !<View> {name: Raw, colorspace: "
         "lin_rec709}\n  Projector:\n    - !<View> {name: Dark, colorspace: film}\n"
         "looks:\n  - !<Look> {name: warm, process_space: lin_rec709, transform: !<CDLTransform> {slope: [1.1, 1, "
         "1]}}\n"
         "colorspaces:\n  - !<ColorSpace> {name: lin_rec709}\n  - !<ColorSpace>\n    name: film\n    "
         "from_scene_reference: " +
         film + "\n" + more;
}

class OcioFiles : public testing::Test {
 protected:
  void SetUp() override {
    unsetenv("OCIO");
    scene.write("tables/curve.spi1d", kCurve);
    scene.write("studio.ocio", config_of("!<FileTransform> {src: curve.spi1d}"));
  }
  void TearDown() override { unsetenv("OCIO"); }
  std::string error(const std::string& settings) {
    scene.stack("fx.ocio_display {\n  " + settings + " }");
    return scene.build_error();
  }
  std::string of_config(const std::string& text) {
    scene.write("broken.ocio", text);
    return error("config = \"broken.ocio\"");
  }
  Scene scene;
};

TEST_F(OcioFiles, LieBesideThePresetOrWhereTheEnvironmentSays) {
  EXPECT_EQ(error("config = \"studio.ocio\""), "");
  setenv("OCIO", (scene.folder() / "studio.ocio").c_str(), 1);
  EXPECT_EQ(error("view = \"Raw\""), "");
  EXPECT_EQ(error("view = \"Dark\", display = \"Projector\", looks = \"+warm, -warm\""), "");
}

/// A tone curve behind the working space is where it should be, whatever the space is called.
TEST_F(OcioFiles, TheWorkingSpaceByItsNameIsNoOther) {
  const auto warnings = [&](const std::string& from, const std::string& to) {
    scene.stack("fx.ocio_transform { config = \"studio.ocio\", from = \"" + from + "\", to = \"" + to +
                "\" }, fx.tone_mapping {}");
    auto preset = scene.load();
    if (!preset) return preset.error().text();
    std::string out;
    const auto spaces = preset->spaces();
    for (const auto& space : *spaces) out += space.warning;
    return out;
  };
  EXPECT_EQ(warnings("film", ""), "");
  EXPECT_EQ(warnings("film", "lin_rec709"), "");
  EXPECT_THAT(warnings("lin_rec709", "film"), HasSubstr("'ocio_transform' before it makes values of another space"));
}

TEST_F(OcioFiles, NoneAtAll) {
  EXPECT_EQ(
      error("view = \"Raw\""),
      "preset.lua:3: error: config: there is no configuration of OpenColorIO: none is given, and the variable OCIO "
      "of the environment is not set; allowed: config = \"NAME.ocio\", a file beside the preset or on the search "
      "path");
  setenv("OCIO", "/nowhere/studio.ocio", 1);
  EXPECT_THAT(error(""), HasSubstr("preset.lua:3: error: config: the variable OCIO of the environment names "
                                   "/nowhere/studio.ocio, and there is no such file; allowed: config = "));
  EXPECT_THAT(error("config = \"stuido.ocio\""),
              HasSubstr("preset.lua:4: error: config = \"stuido.ocio\": there is no such file; allowed: "));
  EXPECT_THAT(error("config = \"stuido.ocio\""), HasSubstr("did you mean 'studio.ocio'?"));
  EXPECT_THAT(error("config = \"../studio.ocio\""), HasSubstr("preset.lua:4: error: ocio_display.config = "));
}

TEST_F(OcioFiles, NamesAreThoseOfTheConfiguration) {
  const std::string config = "config = \"studio.ocio\",\n  ";
  EXPECT_EQ(error(config + "view = \"Flim\""),
            "preset.lua:5: error: view = \"Flim\": display 'Monitor' of the configuration has no view of that name "
            "(studio.ocio); allowed: Film, Raw; did you mean 'Film'?");
  EXPECT_EQ(error(config + "display = \"Monitr\""),
            "preset.lua:5: error: display = \"Monitr\": the configuration has no display of that name (studio.ocio); "
            "allowed: Monitor, Projector; did you mean 'Monitor'?");
  EXPECT_EQ(error(config + "from = \"flm\""),
            "preset.lua:5: error: from = \"flm\": the configuration has no colour space of that name (studio.ocio); "
            "allowed: lin_rec709, film; did you mean 'film'?");
  EXPECT_EQ(
      error(config + "looks = \"+wram\""),
      "preset.lua:5: error: looks = \"+wram\": the configuration has no look 'wram' (studio.ocio); allowed: warm; "
      "did you mean 'warm'?");
  scene.write("plain.ocio",
              "ocio_profile_version: 1\nroles: {default: lnh}\ndisplays: {M: [!<View> {name: V, colorspace: "
              "lnh}]}\ncolorspaces: [!<ColorSpace> {name: lnh}]\n");
  EXPECT_THAT(error("config = \"plain.ocio\""),
              HasSubstr("error: from: the configuration does not say which of its colour spaces is linear Rec.709"));
  EXPECT_EQ(error("config = \"plain.ocio\", from = \"lnh\""), "");
}

TEST_F(OcioFiles, BrokenOnesAreToldByFileAndLine) {
  EXPECT_THAT(of_config("rubbish"), HasSubstr("broken.ocio:1: error: OpenColorIO cannot read it: yaml-cpp: "));
  EXPECT_THAT(of_config(""), HasSubstr("broken.ocio: error: OpenColorIO cannot read it: "));
  EXPECT_THAT(of_config(config_of("!<MatrixTransform> {matrix: [1, 2]}")), HasSubstr("broken.ocio:17: error: "));
  EXPECT_THAT(of_config("ocio_profile_version: 2\nroles: " + std::string(100000, '[')),
              HasSubstr("broken.ocio:2: error: OpenColorIO cannot read it: "));
  EXPECT_THAT(of_config("rubbish"), HasSubstr("in effect 'ocio_display' of preset.lua:3"));
}

TEST_F(OcioFiles, SpacesThatHaveNoEnd) {
  const auto change = [](const std::string& to) { return "!<ColorSpaceTransform> {src: lin_rec709, dst: " + to + "}"; };
  EXPECT_THAT(of_config(config_of(change("film"))), HasSubstr("the colour space 'film' is made of itself"));
  EXPECT_THAT(
      of_config(config_of(change("b"), "  - !<ColorSpace> {name: b, from_scene_reference: " + change("film") + "}\n")),
      HasSubstr("is made of itself"));
  std::string doubled, chain;
  for (int i = 0; i < 40; ++i)
    doubled +=
        fmt::format("  - !<ColorSpace> {{name: d{}, from_scene_reference: !<GroupTransform> {{children: [{}, {}]}}}}\n",
                    i, change(fmt::format("d{}", i + 1)), change(fmt::format("d{}", i + 1)));
  doubled += "  - !<ColorSpace> {name: d40}\n";
  EXPECT_THAT(of_config(config_of(change("d0"), doubled)), HasSubstr("takes more than 4096 transforms"));
  for (int i = 0; i < 100; ++i)
    chain += fmt::format("  - !<ColorSpace> {{name: c{}, from_scene_reference: {}}}\n", i,
                         change(fmt::format("c{}", i + 1)));
  chain += "  - !<ColorSpace> {name: c100}\n";
  EXPECT_THAT(of_config(config_of(change("c0"), chain)), HasSubstr("more than 64 deep"));
}

TEST_F(OcioFiles, TablesThatAreMissingOrWrong) {
  EXPECT_THAT(of_config(config_of("!<FileTransform> {src: curv.spi1d}")),
              HasSubstr("broken.ocio:17: error: 'curv.spi1d': there is no such file along the search path of the "
                        "configuration, like "));
  EXPECT_THAT(of_config(config_of("!<FileTransform> {src: curv.spi1d}")), HasSubstr("did you mean 'curve.spi1d'?"));
  EXPECT_THAT(of_config(config_of("!<FileTransform> {src: none/curve.spi1d}")), HasSubstr("there is no such file"));
  scene.write("tables/huge.cube", "LUT_3D_SIZE 1000000\n");
  EXPECT_THAT(of_config(config_of("!<FileTransform> {src: huge.cube}")),
              HasSubstr("huge.cube:1: error: LUT_3D_SIZE is 1000000"));
  scene.write("tables/more.ctf",
              "<?xml version=\"1.0\"?><ProcessList version=\"1.7\" id=\"a\"><Reference inBitDepth=\"32f\" "
              "outBitDepth=\"32f\" path=\"/etc/passwd\"/></ProcessList>");
  EXPECT_THAT(of_config(config_of("!<FileTransform> {src: more.ctf}")), HasSubstr("refers to another file"));
  scene.write("tables/rubbish.spi1d", "rubbish");
  EXPECT_THAT(of_config(config_of("!<FileTransform> {src: rubbish.spi1d}")), HasSubstr("OpenColorIO cannot read it"));
}

TEST_F(OcioFiles, TablesOfScriptsStayInTheirFolders) {
  const Scene other;
  const fs::path outside = const_cast<Scene&>(other).write("curve.spi1d", kCurve);
  // Of what lies outside not even its name is told, or that it is not there.
  for (const fs::path& missing : {other.folder() / "curv.spi1d", other.folder() / "none" / "curve.spi1d"}) {
    const std::string told = of_config(config_of("!<FileTransform> {src: " + missing.string() + "}"));
    EXPECT_THAT(told, HasSubstr("lies outside of the folders that scripts may read"));
    EXPECT_THAT(told, Not(HasSubstr("did you mean")));
  }
  const std::string text = config_of("!<FileTransform> {src: " + outside.string() + "}");
  EXPECT_THAT(of_config(text), HasSubstr("lies outside of the folders that scripts may read"));
  scene.write("up.ocio",
              config_of("!<FileTransform> {src: ../../" + other.folder().filename().string() + "/curve.spi1d}"));
  EXPECT_THAT(error("config = \"up.ocio\""), HasSubstr("lies outside of the folders that scripts may read"));
  // What the environment or the command line names is the user's own.
  setenv("OCIO", (scene.folder() / "broken.ocio").c_str(), 1);
  EXPECT_EQ(error(""), "");
  unsetenv("OCIO");
  scene.options.overrides = {{"ocio_display", "config", (scene.folder() / "broken.ocio").string()}};
  EXPECT_EQ(error(""), "");
}

TEST_F(OcioFiles, EditsAreNoticed) {
  scene.stack("fx.ocio_display { config = \"studio.ocio\" }");
  const auto shader_of = [&] {
    auto preset = scene.load();
    EXPECT_TRUE(preset);
    auto build = scene.evaluate(*preset);
    EXPECT_TRUE(build) << build.error().text();
    EXPECT_FALSE(first_changed(*build->files));
    for (const char* name : {"studio.ocio", "tables/curve.spi1d"})
      EXPECT_TRUE(build->depends.files.contains(scene.folder() / name)) << name;
    return *build;
  };
  const Build first = shader_of();
  scene.write("tables/curve.spi1d", "Version 1\nFrom 0 1\nLength 2\nComponents 1\n{\n0\n0.5\n}\n");
  EXPECT_EQ(first_changed(*first.files), scene.folder() / "tables/curve.spi1d");
  const Build second = shader_of();
  const auto table_of = [](const Build& build) {
    for (const auto& image : build.graph.images)
      if (image.data) return image.data->hash;
    return Hash{};
  };
  EXPECT_NE(table_of(second), table_of(first));
  scene.write("studio.ocio", config_of("!<ExponentTransform> {value: [2, 2, 2, 1]}"));
  EXPECT_EQ(first_changed(*second.files), scene.folder() / "studio.ocio");
  auto preset = scene.load();
  EXPECT_NE(scene.evaluate(*preset)->graph.passes.at(0).shader, second.graph.passes.at(0).shader);
  // A table that is not there yet is waited for.
  fs::remove(scene.folder() / "tables/curve.spi1d");
  scene.write("studio.ocio", config_of("!<FileTransform> {src: curve.spi1d}"));
  auto waiting = scene.load();
  ASSERT_FALSE(scene.evaluate(*waiting));
  const auto looked = waiting->probes();
  EXPECT_FALSE(first_changed(*looked));
  scene.write("tables/curve.spi1d", kCurve);
  EXPECT_EQ(first_changed(*looked), scene.folder() / "tables/curve.spi1d");
}

/// Looks with others in their place, as OpenColorIO takes them: the first whose files are there.
class OcioChoices : public OcioFiles {
 protected:
  void SetUp() override {
    OcioFiles::SetUp();
    scene.write(
        "choices.ocio",
        "ocio_profile_version: 2\nsearch_path: \"shot:tables\"\nroles: {default: lin_rec709}\n"
        "file_rules: [!<Rule> {name: Default, colorspace: lin_rec709}]\n"
        "displays:\n  Monitor:\n    - !<View> {name: Film, colorspace: lin_rec709, looks: \"shotgrade | warm\"}\n"
        "    - !<View> {name: Plain, colorspace: lin_rec709, looks: \"shotgrade |\"}\n"
        "    - !<View> {name: Lost, colorspace: lin_rec709, looks: \"shotgrade | other\"}\n"
        "looks:\n  - !<Look> {name: warm, process_space: lin_rec709, transform: !<CDLTransform> {slope: [1.1, 1, "
        "1]}}\n  - !<Look> {name: shotgrade, process_space: lin_rec709, transform: !<FileTransform> {src: "
        "shot.spi1d}}\n  - !<Look> {name: other, process_space: lin_rec709, transform: !<FileTransform> {src: "
        "other.spi1d}}\n"
        "colorspaces:\n  - !<ColorSpace> {name: lin_rec709}\n"
        "named_transforms:\n  - !<NamedTransform> {name: twice, transform: !<MatrixTransform> {matrix: [2, 0, 0, "
        "0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1]}}\n");
  }
  std::string looked(const std::string& looks, const std::string& more = "") {
    scene.stack("fx.ocio_transform { config = \"choices.ocio\", looks = \"" + looks + "\"" + more + " }");
    return scene.build_error();
  }
  std::string changed(const std::string& settings) {
    scene.stack("fx.ocio_transform { config = \"choices.ocio\", " + settings + " }");
    return scene.build_error();
  }
};

TEST_F(OcioChoices, TheFirstWhoseFilesAreThereIsTaken) {
  for (const char* view : {"Film", "Plain"})
    EXPECT_EQ(error(fmt::format("config = \"choices.ocio\", view = \"{}\"", view)), "") << view;
  EXPECT_THAT(error("config = \"choices.ocio\", view = \"Lost\""), HasSubstr("'other.spi1d': there is no such file"));
  for (const char* looks :
       {"shotgrade | warm", "shotgrade |", "+warm | missing", "shotgrade, warm | -warm", "| missing"})
    EXPECT_EQ(looked(looks), "") << looks;
  // OpenColorIO comes to a look that it does not know.
  for (const char* looks : {"missing | warm", "shotgrade | missing", "missing |"})
    EXPECT_THAT(looked(looks), HasSubstr("the configuration has no look 'missing'")) << looks;
  scene.write("tables/shot.spi1d", kCurve);
  EXPECT_EQ(looked("shotgrade | missing"), "");
  EXPECT_EQ(error("config = \"choices.ocio\", view = \"Lost\""), "");
}

TEST_F(OcioChoices, AFileThatAppearsIsNoticed) {
  for (const char* place : {"shot/shot.spi1d", "tables/shot.spi1d"}) {
    scene.stack("fx.ocio_display { config = \"choices.ocio\", view = \"Film\" }");
    auto preset = scene.load();
    ASSERT_TRUE(preset);
    auto build = scene.evaluate(*preset);
    ASSERT_TRUE(build) << build.error().text();
    EXPECT_FALSE(first_changed(*build->files));
    EXPECT_FALSE(build->depends.files.contains(scene.folder() / place)) << "nothing is made of it";
    scene.write(place, kCurve);
    EXPECT_EQ(first_changed(*build->files), scene.folder() / place);
    auto again = scene.load();
    auto graded = scene.evaluate(*again);
    ASSERT_TRUE(graded) << graded.error().text();
    EXPECT_NE(graded->graph.passes.at(0).shader, build->graph.passes.at(0).shader);
    EXPECT_TRUE(graded->depends.files.contains(scene.folder() / place));
    fs::remove(scene.folder() / place);
  }
}

TEST_F(OcioChoices, WhatIsThereIsLookedAtLikeAnyOther) {
  scene.write("tables/shot.spi1d", "rubbish");
  EXPECT_THAT(looked("shotgrade | warm"), HasSubstr("OpenColorIO cannot read it"));
}

TEST_F(OcioChoices, NamedTransformsGoFromAndTo) {
  EXPECT_EQ(changed("to = \"twice\""), "");
  EXPECT_EQ(changed("from = \"twice\""), "");
  EXPECT_EQ(changed("from = \"lin_rec709\", to = \"twice\", inverse = true"), "");
  EXPECT_THAT(changed("to = \"twice\", looks = \"warm\""),
              HasSubstr("a named transform goes with no looks and no display"));
  EXPECT_THAT(error("config = \"choices.ocio\", from = \"twice\""), HasSubstr("a named transform goes with no looks"));
  EXPECT_THAT(changed("from = \"lnh\", to = \"twice\""), HasSubstr("no colour space of that name"));
}

TEST_F(OcioFiles, LightIsThatOfADisplayBehindAView) {
  scene.stack("fx.ocio_display { config = \"studio.ocio\" }, fx.exposure { at = \"after_post_process\", ev = 1 }");
  auto preset = scene.load();
  ASSERT_TRUE(preset) << preset.error().text();
  const auto spaces = preset->spaces();
  ASSERT_TRUE(spaces);
  EXPECT_EQ(spaces->at(0).before, LightSpace::scene);
  EXPECT_EQ(spaces->at(0).behind, LightSpace::display);
  EXPECT_THAT(spaces->at(1).warning, HasSubstr("'ocio_display' before it makes display-linear light"));
}

}  // namespace
}  // namespace afterglow
