// SPDX-License-Identifier: MIT
// Scopes, marks, exposure and gamma of the view, regions; where the window is, and the editor; in a real window.
#include "core/text.h"
#include "play_window_test.h"

namespace afterglow {
namespace {

constexpr Color kScopePaper{13, 14, 16};  // of an empty scope
constexpr Color kRegionLine{255, 158, 60};

/// Of a look that keeps only red of 0.5, the luminance is 0.106: the zone of −1 stop.
TEST_F(PlayWindow, MarksGammaAndExposureAreOfTheView) {
  write_preset("{ 1, 0, 0 }");
  play({"look.lua", "shot.0001.exr", "--paused"});
  ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
  EXPECT_TRUE(until_color(kX, kY, kRed));
  ASSERT_TRUE(user("mousemove 400 300 key x"));
  EXPECT_TRUE(until_color(kX, kY, {92, 92, 92}));  // nothing is out of range: grey by its luminance
  ASSERT_TRUE(user("key x"));
  EXPECT_TRUE(until_color(kX, kY, {26, 148, 128}));
  ASSERT_TRUE(user("key Up key Up key Up key Up"));  // a stop
  EXPECT_TRUE(until_color(kX, kY, {128, 128, 128}));
  ASSERT_TRUE(user("key 0 key x"));
  EXPECT_TRUE(until_color(kX, kY, kRed));
  ASSERT_TRUE(user("key shift+Up"));  // 0.5 to the power of 1/1.1, as a code
  EXPECT_TRUE(until_color(kX, kY, {193, 0, 0}));
  ASSERT_TRUE(user("key 0"));
  EXPECT_TRUE(until_color(kX, kY, kRed));
  ASSERT_TRUE(user("key q"));
  expect_clean_end();
}

TEST_F(PlayWindow, ScopesComeAndGoAndARegionIsDrawn) {
  write_preset("{ 1, 0, 0 }");
  play({"look.lua", "shot.0001.exr", "--paused"});
  ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
  EXPECT_TRUE(until_color(kX, kY, kRed));
  EXPECT_EQ(count_color(shot(), kScopePaper), 0);
  ASSERT_TRUE(user("mousemove 300 200"));
  // histogram, waveform, parade, vectorscope: each mostly dark; then all of them
  for (int kind = 0; kind < 4; ++kind) {
    ASSERT_TRUE(user("key h"));
    EXPECT_TRUE(until([&] {
      const int dark = count_color(shot(), kScopePaper);
      return dark > 15000 && dark < 60000;
    })) << kind;
  }
  ASSERT_TRUE(user("key h"));
  EXPECT_TRUE(until([&] { return count_color(shot(), kScopePaper) > 60000; }));
  ASSERT_TRUE(user("key h"));
  EXPECT_TRUE(until([&] { return count_color(shot(), kScopePaper) == 0; }));

  const int before = count_color(shot(), kRegionLine);
  ASSERT_TRUE(
      user("keydown ctrl mousemove 300 200 mousedown 1 mousemove 350 240 mousemove 400 280 mouseup 1 keyup ctrl"));
  EXPECT_TRUE(until([&] { return count_color(shot(), kRegionLine) > before + 300; }));
  ASSERT_TRUE(user("key ctrl+h"));
  EXPECT_TRUE(until([&] { return count_color(shot(), kRegionLine) == before; }));
  ASSERT_TRUE(user("key q"));
  expect_clean_end();
}

/// A configuration whose view halves the codes of red light and takes green's place with blue.
TEST_F(PlayWindow, PicturesAreShownAsADisplayHasThem) {
  write_preset("{ 1, 1, 0 }");
  std::ofstream(folder_ / "studio.ocio") << "ocio_profile_version: 2\nroles: {default: lin_rec709}\nfile_rules: "
                                            "[!<Rule> {name: Default, colorspace: lin_rec709}]\n"
                                            "displays:\n  Wall:\n    - !<View> {name: Swapped, colorspace: swapped}\n"
                                            "colorspaces:\n  - !<ColorSpace> {name: lin_rec709}\n"
                                            "  - !<ColorSpace>\n    name: swapped\n    from_scene_reference: "
                                            "!<MatrixTransform> {matrix: [0.5, 0, 0, 0, 0, 0, 1, "
                                            "0, 0, 1, 0, 0, 0, 0, 0, 1]}\n";
  play({"look.lua", "shot.0001.exr", "--paused", "--view-ocio", "studio.ocio", "--export", "out.exr"});
  ASSERT_TRUE(program_->wait_for("view: Wall, Swapped, within"));
  ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
  constexpr Color kWall{64, 0, 128};
  EXPECT_TRUE(until_color(kX, kY, kWall));
  ASSERT_TRUE(user("mousemove 400 300 key shift+v"));
  EXPECT_TRUE(until_color(kX, kY, {188, 188, 0}));
  ASSERT_TRUE(user("key shift+v"));
  EXPECT_TRUE(until_color(kX, kY, kWall));
  ASSERT_TRUE(user("key s"));  // the frame that is written knows nothing of the display
  ASSERT_TRUE(program_->wait_for("frame written to out.exr"));
  Diagnostics nowhere;
  const auto written = read_picture(folder_ / "out.exr", {}, nowhere);
  ASSERT_TRUE(written) << written.error().text();
  const float* pixel = written->color.at(10, 10);
  EXPECT_TRUE(std::abs(pixel[0] - 0.5f) < 1e-3f && std::abs(pixel[1] - 0.5f) < 1e-3f && pixel[2] == 0);
  ASSERT_TRUE(user("key q"));
  expect_clean_end();
}

/// Of two displays; one's views swap channels or make all of them half as light.
std::string two_displays(const char* light) {
  const auto space = [](const std::string& name, const std::string& matrix) {
    return "  - !<ColorSpace>\n    name: " + name + "\n    from_scene_reference: !<MatrixTransform> {matrix: [" +
           matrix + ", 0, 0, 0, 0, 1]}\n";
  };
  const std::string l = light;
  return "ocio_profile_version: 2\nroles: {default: lin_rec709}\nfile_rules: [!<Rule> {name: Default, colorspace: "
         "lin_rec709}]\ndisplays:\n  Wall:\n    - !<View> {name: Swapped, colorspace: swapped}\n"
         "    - !<View> {name: Dim, colorspace: dim}\n  Floor:\n    - !<View> {name: Dim, colorspace: dim}\n"
         "colorspaces:\n  - !<ColorSpace> {name: lin_rec709}\n" +
         space("swapped", "0.5, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0") +
         space("dim", l + ", 0, 0, 0, 0, " + l + ", 0, 0, 0, 0, " + l);
}

TEST_F(PlayWindow, ViewsOfADisplayAreChosenAndFollowTheirFile) {
  write_preset("{ 1, 1, 0 }");
  const auto write = [&](const std::string& text) { std::ofstream(folder_ / "studio.ocio") << text; };
  write(two_displays("0.25"));
  play({"look.lua", "shot.0001.exr", "--paused", "--view-ocio", "studio.ocio"});
  ASSERT_TRUE(program_->wait_for("view: Wall, Swapped, within"));
  ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
  constexpr Color kSwapped{64, 0, 128}, kDim{32, 32, 0}, kDimmer{16, 16, 0};
  EXPECT_TRUE(until_color(kX, kY, kSwapped));
  ASSERT_TRUE(user("mousemove 400 300 key ctrl+v"));
  ASSERT_TRUE(program_->wait_for("view: Wall, Dim, within"));
  EXPECT_TRUE(until_color(kX, kY, kDim));
  write("displays: [");  // what is on screen stays
  ASSERT_TRUE(program_->wait_for("the view stays as it was: "));
  EXPECT_TRUE(until_color(kX, kY, kDim));
  write(two_displays("0.125"));
  EXPECT_TRUE(until_color(kX, kY, kDimmer));
  ASSERT_TRUE(user("key ctrl+v"));  // behind the last, the first
  EXPECT_TRUE(until_color(kX, kY, kSwapped));
  ASSERT_TRUE(user("key q"));
  expect_clean_end();
}

/// An editor that writes down how it was called.
TEST_F(PlayWindow, AnErrorOpensTheEditorAtItsLine) {
  std::ofstream(folder_ / "editor") << "#!/bin/sh\necho \"$@\" >> called.txt\n";
  fs::permissions(folder_ / "editor", fs::perms::owner_all);
  write_preset("{ 1, 0, 0 }");
  play({"look.lua", "shot.0001.exr", "--paused"});
  ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
  EXPECT_TRUE(until_color(kX, kY, kRed));
  const auto called = [&] { return text_of("called.txt"); };
  ASSERT_TRUE(user("mousemove 400 300 key F4"));
  EXPECT_TRUE(until([&] { return called() == "+1 look.lua\n"; })) << called();
  std::ofstream(folder_ / "look.lua") << "local fx = require \"afterglow\"\n\nreturn fx.stack {\n  fx.bloomy {},\n}\n";
  ASSERT_TRUE(program_->wait_for("reload: failed"));
  ASSERT_TRUE(user("key F4"));
  EXPECT_TRUE(until([&] { return called().ends_with("+4 look.lua\n"); })) << called();
  ASSERT_TRUE(user("key q"));
  expect_clean_end();
}

/// All that the compiler says stands over the picture; F4 steps through the places.
TEST_F(PlayWindow, EachErrorOfAShaderIsListedAndOpens) {
  std::ofstream(folder_ / "editor") << "#!/bin/sh\necho \"$@\" >> called.txt\n";
  fs::permissions(folder_ / "editor", fs::perms::owner_all);
  fs::create_directories(folder_ / "effects");
  fs::create_directories(folder_ / "shaders" / "mine");
  std::ofstream(folder_ / "effects" / "mine.lua")
      << "local fx = require \"afterglow\"\nreturn fx.effect { name = \"mine\", settings = {},\n"
      << "  build = function(g, s, source) return g:pass { shader = \"mine/mine\", source = source } end }\n";
  const auto shader = [&](const std::string& lines) {
    std::ofstream(folder_ / "shaders" / "mine" / "mine.glsl") << "vec4 apply(vec4 c) {\n"
                                                              << lines << "  return vec4(c.r, 0.0, 0.0, c.a);\n}\n";
  };
  shader("");
  std::ofstream(folder_ / "look.lua") << "local fx = require \"afterglow\"\nreturn fx.stack { fx.mine {} }\n";
  play({"look.lua", "shot.0001.exr", "--paused"});
  ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
  EXPECT_TRUE(until_color(kX, kY, kRed));
  const auto edge = [&] { return count_color(shot(), {255, 107, 97}); };  // of the error's sheet, and names of places
  shader("  c.g = one;\n");
  ASSERT_TRUE(program_->wait_for("reload: failed"));
  EXPECT_TRUE(until([&] { return edge() > 100; }));
  const int of_one = edge();
  shader("  c.g = one;\n  c.b = two;\n  c.g = three;\n");
  EXPECT_TRUE(until([&] { return edge() > of_one + 100; })) << "the sheet has grown by two errors";
  const auto called = [&] { return text_of("called.txt"); };
  std::string opened;
  for (const char* line : {"+2 ", "+3 ", "+4 ", "+2 "}) {
    opened += line;
    ASSERT_TRUE(user("mousemove 400 300 key F4"));
    EXPECT_TRUE(until([&] {
      std::string lines;
      for (const auto& one : split(called(), '\n')) lines += one.substr(0, 3);
      return lines == opened;
    })) << called();
  }
  ASSERT_TRUE(user("key q"));
  expect_clean_end();
}

/// As --geometry says; without it as it was left.
TEST_F(PlayWindow, TheWindowIsWhereItIsWanted) {
  write_preset("{ 1, 0, 0 }");
  const auto place = [&] { return window_place(xvfb_.display()); };
  play({"look.lua", "shot.0001.exr", "--geometry", "700x500+30+20"});
  ASSERT_TRUE(program_->wait_for("window 700x500"));
  EXPECT_EQ(place(), (Rect{30, 20, 700, 500}));
  ASSERT_TRUE(user("mousemove 200 200 key q"));
  expect_clean_end();
  EXPECT_FALSE(fs::exists(folder_ / "afterglow/window")) << "one that was asked for is not remembered";

  fs::create_directories(folder_ / "afterglow");
  std::ofstream(folder_ / "afterglow/window") << "800x600+10+40\n";
  play({"look.lua", "shot.0001.exr"});
  ASSERT_TRUE(program_->wait_for("window 800x600"));
  EXPECT_EQ(place(), (Rect{10, 40, 800, 600}));
  ASSERT_TRUE(user("search --class afterglow windowsize 760 520 windowmove 50 60"));
  ASSERT_TRUE(until([&] { return place() == Rect{50, 60, 760, 520}; }));
  ASSERT_TRUE(user("mousemove 300 300 key q"));
  expect_clean_end();
  EXPECT_EQ(text_of("afterglow/window"), "760x520+50+60\n");
}

TEST_F(PlayWindow, SettingsOfTheUserHoldForEveryWindow) {
  write_preset("{ 1, 0, 0 }");
  fs::create_directories(folder_ / "afterglow");
  std::ofstream(folder_ / "afterglow/play.conf") << "# mine\ngeometry = 640x480+5+5\npaused = true  # begin so\n"
                                                 << "export = graded.####.exr  # no comment is the pattern\n";
  play({"look.lua", "shot.####.exr"});
  ASSERT_TRUE(program_->wait_for("window 640x480"));
  ASSERT_TRUE(user("mousemove 150 150 key s"));
  EXPECT_TRUE(until([&] { return fs::exists(folder_ / "graded.0001.exr"); }));
  ASSERT_TRUE(user("key q"));
  expect_clean_end();
  play({"look.lua", "shot.####.exr", "--geometry", "660x490"});
  ASSERT_TRUE(program_->wait_for("window 660x490")) << "the command line counts more";
  ASSERT_TRUE(user("mousemove 150 150 key q"));
  expect_clean_end();
  std::ofstream(folder_ / "afterglow/play.conf") << "\ngeometri = 640x480\n";
  play({"look.lua", "shot.####.exr"});
  EXPECT_EQ(program_->finish(), 2);
  EXPECT_NE(program_->printed().find("play.conf:2: error: there is no setting 'geometri'"), std::string::npos);
  EXPECT_NE(program_->printed().find("did you mean 'geometry'?"), std::string::npos);
  std::ofstream(folder_ / "afterglow/play.conf") << "ui-scale = 9\n";
  play({"look.lua", "shot.####.exr"});
  EXPECT_EQ(program_->finish(), 2);
  EXPECT_NE(program_->printed().find("play.conf:1: error: "), std::string::npos);
  for (const std::string wrong : {"proxy = 1/3", "view-icc = none.icc", "cache = much", "loop = round"}) {
    std::ofstream(folder_ / "afterglow/play.conf") << "# mine\n" << wrong << "\n";
    play({"look.lua", "shot.####.exr"});
    EXPECT_EQ(program_->finish(), 2) << wrong;
    EXPECT_NE(program_->printed().find("play.conf:2: error: " + wrong.substr(0, wrong.find(' ')) + ": '"),
              std::string::npos)
        << program_->printed();
  }
}

}  // namespace
}  // namespace afterglow
