// SPDX-License-Identifier: MIT
// What a player must not get wrong: images between passes of any size, a bar whose pieces can be read and reached in
// every window, tips that stay out of the way, the keyboard alone, desktops with more pixels, videos frame by frame.
#include <lcms2.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <utility>

#include "play_window_test.h"

namespace afterglow {
namespace {

constexpr Color kAccent{255, 158, 60}, kPanelGround{30, 30, 31};

class PlayMended : public PlayWindow {
 protected:
  void open(const std::vector<std::string>& arguments) {
    write_preset("{ 1, 1, 1 }");
    std::vector<std::string> all{"look.lua"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    play(all);
    ASSERT_TRUE(program_->wait_for("shown "));
  }
  void quit() {
    ASSERT_TRUE(user("key q"));
    expect_clean_end();
  }
  void click(const Rect& at) {
    ASSERT_TRUE(user("mousemove " + std::to_string(at.x + at.width / 2) + " " + std::to_string(at.y + at.height / 2) +
                     " click 1"));
    ASSERT_TRUE(user("mousemove 250 120"));
  }
  /// Fields and buttons of a part of the screen: what hangs together of their two greys, row by row, from left to
  /// right.
  static std::vector<Rect> boxes(const Screen& screen, const Rect& part) {
    constexpr Color kButton{52, 52, 53}, kField{46, 46, 47};
    const auto index = [&](int x, int y) { return static_cast<std::size_t>(y - part.y) * part.width + (x - part.x); };
    std::vector<char> seen(static_cast<std::size_t>(part.size().area()), 0);
    std::vector<Rect> out;
    for (int y = part.y; y < part.y + part.height; ++y)
      for (int x = part.x; x < part.x + part.width; ++x) {
        const Color color = is(screen.at(x, y), kButton) ? kButton : kField;
        if (seen[index(x, y)] || !is(screen.at(x, y), color)) continue;
        std::vector<std::pair<int, int>> next{{x, y}};
        seen[index(x, y)] = 1;
        int left = x, right = x, top = y, bottom = y;
        while (!next.empty()) {
          const auto [px, py] = next.back();
          next.pop_back();
          left = std::min(left, px), right = std::max(right, px), top = std::min(top, py),
          bottom = std::max(bottom, py);
          const std::pair<int, int> beside[] = {{px - 1, py}, {px + 1, py}, {px, py - 1}, {px, py + 1}};
          for (const auto& [nx, ny] : beside) {
            if (nx < part.x || ny < part.y || nx >= part.x + part.width || ny >= part.y + part.height) continue;
            if (seen[index(nx, ny)] || !is(screen.at(nx, ny), color)) continue;
            seen[index(nx, ny)] = 1;
            next.emplace_back(nx, ny);
          }
        }
        if (right - left > 14 && bottom - top > 14) out.push_back({left, top, right - left + 1, bottom - top + 1});
      }
    std::ranges::sort(out,
                      [](const Rect& a, const Rect& b) { return std::abs(a.y - b.y) > 8 ? a.y < b.y : a.x < b.x; });
    return out;
  }
  static bool meet(const Rect& a, const Rect& b) {
    return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
  }
  /// From left to right and from top to bottom.
  enum Box { kFirst, kBack, kPlay, kOn, kLast, kLoop, kSpeed, kRate, kEvery, kZoom, kFilter, kBoxes };
  /// The bar of a window that begins in the screen's corner, once it stands; so wide.
  std::vector<Rect> bar_of(Size window, int panel, int wide) {
    std::vector<Rect> out;
    EXPECT_TRUE(until([&] {
      const std::vector<Rect> before = std::exchange(out, {});
      const Screen screen = shot();
      // The window has this size already: its panel begins where it should.
      const auto ground = [&](int x) { return is(screen.at(x, 6), kPanelGround); };
      if (screen.rgb.empty() || !ground(window.width - panel + 3) || ground(window.width - panel - 3)) return false;
      const int height = std::min(window.height / 2, 300);
      out = boxes(screen, {0, window.height - height, wide, height});
      if (out.size() < kBoxes) return false;
      out.erase(out.begin(), out.end() - kBoxes);  // the panel above it, and the timeline, which its playhead parts
      return out == before;
    })) << out.size()
        << " fields and buttons";
    return out;
  }
};

TEST_F(PlayMended, ImagesBetweenPassesOfAnySizeAreShown) {
  std::ofstream(folder_ / "look.lua")
      << "local fx = require \"afterglow\"\nreturn fx.stack {\n  name = \"test look\",\n"
         "  fx.bloom { threshold = 1, intensity = 0.2 },\n}\n";
  play({"look.lua", "shot.0001.exr", "--paused"});
  ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
  ASSERT_TRUE(until_color(kX, kY, kGray));
  ASSERT_TRUE(user("mousemove 400 300"));
  const auto names_an_image = [&] { return count_color(shot(), kAccent) > 10; };  // "image: …", at the upper left
  ASSERT_TRUE(until([&] {
    return user("key n") && has_color(shot(), kX, kY, {0, 0, 0});
  })) << "nothing of 0.5 is above the threshold: the bright parts are black";
  EXPECT_TRUE(until(names_an_image));
  // All of them, round and back to the result: none is an error.
  for (int i = 0; i < 12; ++i) {
    ASSERT_TRUE(user("key n"));
    EXPECT_EQ(count_color(shot(), {255, 107, 97}), 0) << "after " << i;
  }
  ASSERT_TRUE(user("key BackSpace"));
  EXPECT_TRUE(until_color(kX, kY, kGray));
  quit();
  EXPECT_EQ(program_->printed().find("another size"), std::string::npos);
}

TEST_F(PlayMended, APresetForBThatIsNotThereIsNoWindow) {
  write_preset("{ 1, 0, 0 }");
  play({"look.lua", "shot.0001.exr", "--b", "none.lua"});
  EXPECT_EQ(program_->finish(), 3);
  EXPECT_NE(program_->printed().find("none.lua: error: no such file"), std::string::npos);
}

/// At each size all pieces of the bar are there, none lies on another, and a click reaches the one that is meant.
TEST_F(PlayMended, ThePiecesOfTheBarStandApartInEveryWindow) {
  for (const char* scale : {"1", "2"}) {
    ASSERT_NO_FATAL_FAILURE(open({"shot.####.exr", "--paused", "--ui-scale", scale, "--geometry", "1280x800+0+0"}));
    for (const Size size : {Size{900, 700}, Size{1100, 700}, Size{1280, 800}}) {
      SCOPED_TRACE(std::string("scale ") + scale + ", " + std::to_string(size.width));
      const std::string wanted = std::to_string(size.width) + " " + std::to_string(size.height);
      ASSERT_TRUE(until([&] { return user("mousemove 250 120 search --class afterglow windowsize " + wanted); }));
      const int panel = std::min(376 * std::atoi(scale), static_cast<int>(size.width * 0.6));
      const bool narrow = size.width == 900 || std::string(scale) == "2";  // the bar goes below the panel too
      const int wide = narrow ? size.width : size.width - panel;
      auto bar = bar_of(size, panel, wide);
      ASSERT_EQ(bar.size(), static_cast<std::size_t>(kBoxes));
      for (std::size_t a = 0; a < bar.size(); ++a) {
        EXPECT_LT(bar[a].x + bar[a].width, wide);
        EXPECT_LT(bar[a].y + bar[a].height, size.height);
        for (std::size_t b = 0; b < a; ++b) EXPECT_FALSE(meet(bar[a], bar[b])) << a << " and " << b;
      }
      ASSERT_TRUE(user("key Home"));
      ASSERT_NO_FATAL_FAILURE(click(bar[kOn]));
      EXPECT_TRUE(program_->wait_for("position 1"));
      ASSERT_NO_FATAL_FAILURE(click(bar[kLast]));
      EXPECT_TRUE(program_->wait_for("position 2"));
      ASSERT_NO_FATAL_FAILURE(click(bar[kFirst]));
      EXPECT_TRUE(program_->wait_for("position 0"));
    }
    ASSERT_NO_FATAL_FAILURE(quit());
  }
}

TEST_F(PlayMended, TheRangeIsSeenOnTheTimeline) {
  ASSERT_NO_FATAL_FAILURE(open({"shot.####.exr", "--paused"}));
  const Color lit{78, 84, 94}, dark{14, 15, 17};
  EXPECT_TRUE(until([&] { return count_color(shot(), {46, 46, 47}) > 2000; }));
  EXPECT_EQ(count_color(shot(), lit), 0);
  ASSERT_TRUE(user("mousemove 400 300 key Right key i"));
  EXPECT_TRUE(until([&] {
    const Screen screen = shot();
    return count_color(screen, lit) > 4000 && count_color(screen, dark) > 2000;
  })) << "two of three frames are lit, the first is dark";
  ASSERT_TRUE(user("key p"));
  EXPECT_TRUE(until([&] { return count_color(shot(), lit) == 0; }));
  quit();
}

/// Columns of light and of none: the nearest pixel has no colour between, a linear way has.
TEST_F(PlayMended, TheBarSwitchesZoomAndWhatLiesBetweenPixels) {
  ASSERT_NO_FATAL_FAILURE(write_picture_file("columns.exr", [](int x, int) {
    const float level = x % 2 == 0 ? 0.5f : 0.0f;
    return Light{level, level, level};
  }));
  ASSERT_NO_FATAL_FAILURE(open({"columns.exr", "--geometry", "1280x800+0+0"}));
  const auto between = [&] {
    const Screen screen = shot();
    int count = 0;
    for (int x = 0; x < 890; ++x) count += screen.at(x, 240)[0] > 60 && screen.at(x, 240)[0] < 160;
    return count;
  };
  const auto light = [&] { return count_color(shot(), kGray); };
  ASSERT_TRUE(user("mousemove 250 795"));
  EXPECT_TRUE(until([&] { return light() > 100'000; }));
  EXPECT_EQ(between(), 0);
  const auto bar = bar_of({1280, 800}, 376, 904);
  ASSERT_EQ(bar.size(), static_cast<std::size_t>(kBoxes));
  ASSERT_NO_FATAL_FAILURE(click(bar[kFilter]));
  EXPECT_TRUE(until([&] { return between() > 200; }));
  ASSERT_NO_FATAL_FAILURE(click(bar[kFilter]));
  EXPECT_TRUE(until([&] { return between() == 0; }));
  ASSERT_NO_FATAL_FAILURE(click(bar[kZoom]));
  EXPECT_TRUE(until([&] { return light() == 32 * 40; })) << "a pixel for a pixel";
  ASSERT_TRUE(user("key f"));
  EXPECT_TRUE(until([&] { return light() > 100'000; }));
  quit();
}

TEST_F(PlayMended, ThePixelWhoseValuesAreToldIsMarked) {
  ASSERT_NO_FATAL_FAILURE(open({"shot.0001.exr", "--geometry", "1280x800+0+0"}));
  const auto white = [&] {  // around the pointer's place
    const Screen screen = shot();
    int count = 0;
    for (int y = 270; y < 330; ++y)
      for (int x = 370; x < 430; ++x) count += screen.at(x, y)[0] > 215;
    return count;
  };
  EXPECT_TRUE(until_color(kX, kY, kGray));
  EXPECT_EQ(white(), 0);
  ASSERT_TRUE(user("mousemove 400 300"));
  EXPECT_TRUE(until([&] { return white() > 40; })) << "a frame around 14 × 14 pixels";
  ASSERT_TRUE(user("mousemove 1150 790"));
  EXPECT_TRUE(until([&] { return white() == 0; })) << "the pointer is elsewhere";
  quit();
}

/// While a slider is held nothing comes up under it; when the pointer rests there a tip does. A save leaves all rows
/// where they are.
TEST_F(PlayMended, TipsAndMessagesStayOutOfTheWay) {
  std::ofstream(folder_ / "look.lua") << "local fx = require \"afterglow\"\nreturn fx.stack {\n  fx.color_adjustments "
                                         "{ hue_shift = 0.01, saturation = 0 },\n}\n";
  play({"look.lua", "shot.0001.exr", "--paused", "--geometry", "1280x800+0+0"});
  ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
  ASSERT_TRUE(user("mousemove 400 300 key ctrl+f type saturation"));
  ASSERT_TRUE(user("key Return"));
  ASSERT_TRUE(until([&] { return shows_handle(1004); }));
  // Below the only row nothing else is drawn.
  const auto below = [&] {
    const Screen screen = shot();
    int count = 0;
    for (int y = 190; y < 330; ++y)
      for (int x = 910; x < 1270; ++x) count += !is(screen.at(x, y), kPanelGround);
    return count;
  };
  EXPECT_EQ(below(), 0);
  ASSERT_TRUE(user("mousemove 1004 171 mousedown 1 mousemove 1030 171 mousemove 1060 171"));
  EXPECT_TRUE(until([&] { return shows_handle(1060); })) << "the slider follows";
  EXPECT_EQ(below(), 0) << "nothing covers what is dragged";
  ASSERT_TRUE(user("mouseup 1"));
  EXPECT_TRUE(until([&] { return below() > 500; })) << "the tip, when the pointer rests";
  ASSERT_TRUE(user("mousemove 400 300"));
  EXPECT_TRUE(until([&] { return below() == 0; }));
  const Screen before = shot();
  ASSERT_TRUE(user("key ctrl+s"));
  EXPECT_TRUE(until([&] { return text_of("look.lua").find("saturation = 0 }") == std::string::npos; }));
  ASSERT_TRUE(program_->wait_for("reload"));
  EXPECT_TRUE(until([&] { return !is(shot().at(450, 24), {26, 26, 26}); })) << "the message, over the picture";
  EXPECT_TRUE(shows_handle(1060)) << "the row is where it was";
  const Screen after = shot();
  for (int y = 165; y < 178; ++y) EXPECT_EQ(before.at(930, y)[0], after.at(930, y)[0]) << y;
  quit();
}

/// The slider's field and the menu of a right click are come to without a mouse; the bar takes the keyboard and gives
/// it back.
TEST_F(PlayMended, TheKeyboardAloneChangesSettings) {
  std::ofstream(folder_ / "look.lua")
      << "local fx = require \"afterglow\"\nreturn fx.stack {\n  name = \"test look\",\n  fx.color_adjustments { "
         "hue_shift = 0.01, saturation = 0 },\n}\n";
  constexpr Color kColored{203, 89, 89}, kDull{126, 126, 126};
  for (const char* name : {"c.0001.exr", "c.0002.exr", "c.0003.exr"})
    ASSERT_NO_FATAL_FAILURE(write_picture_file(name, Light{0.6f, 0.1f, 0.1f}));
  play({"look.lua", "c.####.exr", "--paused", "--geometry", "1280x800+0+0"});
  ASSERT_TRUE(program_->wait_for("shown c.0001.exr"));
  ASSERT_TRUE(until_color(kX, kY, kColored));
  ASSERT_TRUE(user("key ctrl+f type saturation"));
  ASSERT_TRUE(user("key Return"));
  ASSERT_TRUE(until([&] { return shows_handle(1004); })) << "the search has not found the setting alone";
  const auto framed = [&](int x, int y) {
    return until([&] {
      const Screen screen = shot();
      return !screen.rgb.empty() && is(screen.at(x, y), kAccent);
    });
  };
  ASSERT_TRUE(user("key F6"));
  EXPECT_TRUE(framed(905, 500)) << "the panel has the keyboard";
  ASSERT_TRUE(user("key End key Return type -- -100"));
  ASSERT_TRUE(user("key Return"));
  EXPECT_TRUE(until_color(kX, kY, kDull)) << "typed into the last item";
  ASSERT_TRUE(user("key ctrl+z"));
  EXPECT_TRUE(until_color(kX, kY, kColored)) << "shortcuts with Ctrl are there all the time, and it was one step";
  ASSERT_TRUE(user("key ctrl+shift+z"));
  EXPECT_TRUE(until_color(kX, kY, kDull));
  ASSERT_TRUE(user("key End key shift+F10"));
  EXPECT_TRUE(until([&] { return count_color(shot(), {36, 36, 37}) > 2000; })) << "the menu of the row";
  ASSERT_TRUE(user("key Return"));
  EXPECT_TRUE(until_color(kX, kY, kColored)) << "as in the file";

  ASSERT_TRUE(user("key F6"));
  EXPECT_TRUE(framed(1, 780)) << "the bar has it";
  ASSERT_TRUE(user("key Escape"));
  EXPECT_TRUE(until([&] { return !is(shot().at(1, 780), kAccent); })) << "back at the picture";
  ASSERT_TRUE(user("key Right"));
  EXPECT_TRUE(program_->wait_for("position 1")) << "keys are shortcuts again";

  ASSERT_TRUE(user("key 1 key alt+Left"));
  EXPECT_TRUE(until([&] { return count_color(shot(), kColored) == 64 * 40; }));
  ASSERT_TRUE(user("key ctrl+p"));
  ASSERT_TRUE(program_->wait_for("keys written to"));
  EXPECT_NE(text_of("afterglow-keys.html").find("<td>Ctrl+P</td>"), std::string::npos);
  quit();
}

/// Desktops say how many pixels theirs have to the inch: twice the usual is twice the size.
TEST_F(PlayMended, TheInterfaceHasTheDesktopsScale) {
  ASSERT_TRUE(set_dots_per_inch(xvfb_.display(), 192));
  ASSERT_NO_FATAL_FAILURE(open({"shot.0001.exr", "--geometry", "1280x800+0+0"}));
  EXPECT_TRUE(until([&] {
    const Screen screen = shot();
    // The panel takes 752 pixels in place of 376; the bar's row is twice as high.
    return !screen.rgb.empty() && is(screen.at(536, 10), kPanelGround) && is(screen.at(536, 790), kPanelGround);
  }));
  EXPECT_TRUE(has_color(shot(), 0.2, 0.3, kGray)) << "the picture has the rest";
  quit();
}

/// A monitor whose green is the picture's red, and then one as they are: the window follows the file.
TEST_F(PlayMended, AnEditedProfileIsTaken) {
  const auto save = [&](double exponent) {
    const cmsCIExyY white{0.3127, 0.3290, 1};
    const cmsCIExyYTRIPLE primaries{{0.64, 0.33, 1}, {0.30, 0.60, 1}, {0.15, 0.06, 1}};
    cmsToneCurve* curve = cmsBuildGamma(nullptr, exponent);
    cmsToneCurve* curves[] = {curve, curve, curve};
    const cmsHPROFILE profile = cmsCreateRGBProfile(&white, &primaries, curves);
    const fs::path next = folder_ / "next.icc";
    EXPECT_TRUE(cmsSaveProfileToFile(profile, next.c_str()));
    cmsCloseProfile(profile);
    cmsFreeToneCurve(curve);
    fs::rename(next, folder_ / "monitor.icc");
  };
  save(1);
  ASSERT_NO_FATAL_FAILURE(open({"shot.0001.exr", "--paused", "--view-icc", "monitor.icc"}));
  EXPECT_TRUE(until_color(kX, kY, {128, 128, 128})) << "codes are light";
  save(2);
  EXPECT_TRUE(until_color(kX, kY, {180, 180, 180})) << "255·0.5^½";
  std::ofstream(folder_ / "monitor.icc") << "no profile";
  ASSERT_TRUE(program_->wait_for("the view stays as it was: "));
  EXPECT_TRUE(has_color(shot(), kX, kY, {180, 180, 180}));
  save(1);
  EXPECT_TRUE(until_color(kX, kY, {128, 128, 128}));
  quit();
}

/// Grey frames that tell their number, far between key frames: each one that is gone to is that one.
TEST_F(PlayMended, VideosShowTheFrameThatIsAskedFor) {
  constexpr int kFrames = 24;
  const auto make = [&](const std::string& arguments, const char* name) {
    return std::system(("ffmpeg -v error -f lavfi -i \"color=c=black:s=64x40:r=24,geq=lum='20+8*N':cb=128:cr=128,"
                        "trim=end_frame=24\" -c:v libx264 -bf 3 -g 100 -qp 8 -color_range tv " +
                        arguments + " " + (folder_ / name).string())
                           .c_str());
  };
  std::vector<int> levels;  // of each frame, one after the other
  const auto level = [&] {
    const Screen screen = shot();
    return screen.rgb.empty() ? -1 : static_cast<int>(screen.at(400, 240)[0]);
  };
  const auto shows = [&](int frame) {
    return until([&] { return std::abs(level() - levels[static_cast<std::size_t>(frame)]) <= 1; });
  };
  ASSERT_EQ(make("", "clip.mp4"), 0);
  ASSERT_NO_FATAL_FAILURE(open({"clip.mp4", "--paused"}));
  ASSERT_TRUE(until([&] { return level() >= 0 && level() < 25; }));
  ASSERT_TRUE(user("mousemove 400 120"));
  for (int frame = 0; frame < kFrames; ++frame) {
    if (frame > 0) {
      ASSERT_TRUE(user("key Right"));
    }
    ASSERT_TRUE(program_->wait_for("position " + std::to_string(frame) + ",") || frame == 0);
    ASSERT_TRUE(until([&] { return levels.empty() || level() > levels.back() + 3; })) << "each is brighter: " << frame;
    levels.push_back(level());
  }
  std::mt19937 random(3);
  for (int seek = 0; seek < 12; ++seek) {
    const int frame = std::uniform_int_distribution(0, kFrames - 1)(random);
    ASSERT_TRUE(user("key ctrl+g type " + std::to_string(frame + 1)));
    ASSERT_TRUE(user("key Return"));
    EXPECT_TRUE(shows(frame)) << "frame " << frame << " after " << seek << " seeks";
  }
  ASSERT_TRUE(user("key End"));
  EXPECT_TRUE(shows(kFrames - 1));
  ASSERT_TRUE(user("key Left"));
  EXPECT_TRUE(shows(kFrames - 2)) << "backwards, over frames that lean on later ones";
  quit();

  // A rate that changes: the last frame comes at its own time, as the last one.
  ASSERT_EQ(make("-vf \"setpts='if(lt(N,12),N,12+(N-12)*3)/24/TB'\" -vsync passthrough", "uneven.mkv"), 0);
  ASSERT_NO_FATAL_FAILURE(open({"uneven.mkv", "--paused"}));
  ASSERT_TRUE(shows(0));  // the window is there: keys find it
  ASSERT_TRUE(user("mousemove 400 120 key End"));
  EXPECT_TRUE(shows(kFrames - 1));
  ASSERT_TRUE(user("key Home"));
  EXPECT_TRUE(shows(0));
  quit();

  // Turned by what the file says: lower than wide becomes higher than wide, with borders at its sides.
  const auto turn = [&](const std::string& before,
                        const std::string& behind) {  // as FFmpeg says it from 6 on, and before
    return std::system(("ffmpeg -y -v error " + before + " -i " + (folder_ / "clip.mp4").string() + " -c copy " +
                        behind + " " + (folder_ / "turned.mp4").string())
                           .c_str());
  };
  ASSERT_TRUE(turn("-display_rotation 90", "") == 0 || turn("", "-metadata:s:v:0 rotate=90") == 0);
  ASSERT_NO_FATAL_FAILURE(open({"turned.mp4", "--paused", "--geometry", "1280x800+0+0"}));
  ASSERT_TRUE(user("mousemove 400 790"));
  EXPECT_TRUE(until([&] {
    const Screen screen = shot();
    return !screen.rgb.empty() && is(screen.at(60, 240), {26, 26, 26}) && is(screen.at(840, 240), {26, 26, 26});
  })) << "beside it";
  EXPECT_LE(std::abs(shot().at(450, 60)[0] - levels[0]), 4) << "from the top to the bar";
  quit();
}

}  // namespace
}  // namespace afterglow
