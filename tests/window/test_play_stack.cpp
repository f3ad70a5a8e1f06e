// SPDX-License-Identifier: MIT
// What a user does to the stack of a preset in the window: effects added, removed, copied, moved, undone and saved.
#include "play_window_test.h"

namespace afterglow {
namespace {

constexpr Color kHalved{137, 137, 137}, kQuartered{99, 99, 99};  // sRGB codes of 0.25 and 0.125

class PlayStack : public PlayWindow {
 protected:
  const std::string begin = "local fx = require \"afterglow\"\n-- mine\nreturn fx.stack {\n  name = \"test look\",\n",
                    end = "}\n";
  void open(const std::string& entries) {
    std::ofstream(folder_ / "look.lua") << begin << entries << end;
    play({"look.lua", "shot.0001.exr"});
    ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
    ASSERT_TRUE(user("mousemove 400 300"));
  }
  /// Saves until the file says this; what is being built is waited for so.
  bool saved(const std::string& entries, const std::string& name = "look.lua") {
    return until([&] { return user("key ctrl+s") && text_of(name) == begin + entries + end; });
  }
  void quit() {
    ASSERT_TRUE(user("key q"));
    expect_clean_end();
  }
};

const std::string kDarker = "  fx.color_adjustments { post_exposure = -1 },  -- darker\n";

TEST_F(PlayStack, EffectsAreAddedAndSaved) {
  ASSERT_NO_FATAL_FAILURE(open(kDarker));
  ASSERT_TRUE(until_color(kX, kY, kHalved));
  ASSERT_TRUE(user("key ctrl+a type pixelat"));
  ASSERT_TRUE(user("key Return"));
  ASSERT_TRUE(program_->wait_for("reload"));
  EXPECT_TRUE(saved(kDarker + "  fx.pixelate {},\n")) << text_of("look.lua");
  // The same, told by nothing but its keys; and Escape adds nothing.
  ASSERT_TRUE(user("key ctrl+a type vignette"));
  ASSERT_TRUE(user("key Escape"));
  ASSERT_TRUE(user("key ctrl+a type color_adj"));
  ASSERT_TRUE(user("key Return"));
  EXPECT_TRUE(saved(kDarker + "  fx.color_adjustments {},\n  fx.pixelate {},\n")) << text_of("look.lua");
  quit();
}

TEST_F(PlayStack, EffectsAreRemovedCopiedUndoneAndDoneAgain) {
  ASSERT_NO_FATAL_FAILURE(open(kDarker));
  ASSERT_TRUE(until_color(kX, kY, kHalved));
  ASSERT_TRUE(user("key Page_Down key ctrl+d"));
  EXPECT_TRUE(until_color(kX, kY, kQuartered)) << "twice";
  ASSERT_TRUE(user("key Delete"));
  EXPECT_TRUE(until_color(kX, kY, kHalved)) << "once";
  ASSERT_TRUE(user("key ctrl+z"));
  EXPECT_TRUE(until_color(kX, kY, kQuartered));
  ASSERT_TRUE(user("key ctrl+z"));
  EXPECT_TRUE(until_color(kX, kY, kHalved));
  ASSERT_TRUE(user("key Page_Up key Delete"));
  EXPECT_TRUE(until_color(kX, kY, kGray)) << "not at all";
  EXPECT_EQ(text_of("look.lua"), begin + kDarker + end) << "not before it is saved";
  ASSERT_TRUE(user("key q"));
  ASSERT_TRUE(program_->wait_for("asked whether to save"));
  ASSERT_TRUE(user("key Escape"));
  EXPECT_TRUE(saved(""));
  ASSERT_TRUE(user("key ctrl+z"));
  EXPECT_TRUE(until_color(kX, kY, kHalved)) << "over the save";
  EXPECT_TRUE(saved(kDarker)) << "byte for byte as it was";
  quit();
}

TEST_F(PlayStack, EffectsAreMoved) {
  const std::string gray = "  fx.color_adjustments { saturation = -100 },\n",
                    red = "  -- red\n  fx.color_adjustments { color_filter = { 1, 0, 0 } },  -- alone\n";
  ASSERT_NO_FATAL_FAILURE(open(red + gray));
  ASSERT_TRUE(until([&] {
    const Screen screen = shot();
    return !screen.rgb.empty() && !has_color(screen, kX, kY, kRed) && !has_color(screen, kX, kY, kGray);
  })) << "the red is taken out again";
  ASSERT_TRUE(user("key Page_Down key ctrl+Down"));
  EXPECT_TRUE(until_color(kX, kY, kRed)) << "last";
  EXPECT_TRUE(saved(gray + red)) << text_of("look.lua");
  ASSERT_TRUE(user("key ctrl+Up"));
  EXPECT_TRUE(saved(red + gray)) << text_of("look.lua");
  quit();
}

TEST_F(PlayStack, EffectsAreSwitchedAndTakeTheSettingsOfOthers) {
  ASSERT_NO_FATAL_FAILURE(open(kDarker + "  fx.color_adjustments {},\n"));
  ASSERT_TRUE(until_color(kX, kY, kHalved));
  ASSERT_TRUE(user("key Page_Down key ctrl+e"));
  EXPECT_TRUE(until_color(kX, kY, kGray)) << "off";
  ASSERT_TRUE(user("key ctrl+e"));
  EXPECT_TRUE(until_color(kX, kY, kHalved)) << "on";
  ASSERT_TRUE(user("key ctrl+shift+c key Page_Down key ctrl+shift+v"));
  EXPECT_TRUE(until_color(kX, kY, kQuartered)) << "both are darker";
  EXPECT_TRUE(saved(kDarker + "  fx.color_adjustments { post_exposure = -1 },\n")) << text_of("look.lua");
  quit();
}

TEST_F(PlayStack, SnapshotsAreFlippedBetween) {
  ASSERT_NO_FATAL_FAILURE(open(kDarker));
  ASSERT_TRUE(until_color(kX, kY, kHalved));
  ASSERT_TRUE(user("key ctrl+shift+1 key Page_Down key ctrl+d"));
  ASSERT_TRUE(until_color(kX, kY, kQuartered));
  ASSERT_TRUE(user("key ctrl+shift+2 key ctrl+1"));
  EXPECT_TRUE(until_color(kX, kY, kHalved));
  ASSERT_TRUE(user("key ctrl+2"));
  EXPECT_TRUE(until_color(kX, kY, kQuartered));
  EXPECT_TRUE(saved(kDarker + "  fx.color_adjustments { post_exposure = -1 },\n")) << text_of("look.lua");
  ASSERT_TRUE(user("key ctrl+1"));
  EXPECT_TRUE(until_color(kX, kY, kHalved)) << "over a save";
  EXPECT_TRUE(saved(kDarker)) << text_of("look.lua");
  quit();
}

/// By the mouse: where the menu of the first effect lies in a window of 1280×800.
TEST_F(PlayStack, TheMenuOfAnEffectCopiesItAndGivesItAMask) {
  ASSERT_NO_FATAL_FAILURE(open(kDarker));
  ASSERT_TRUE(until_color(kX, kY, kHalved));
  const auto pixel = [](const Screen& screen, int x, int y) {
    const std::uint8_t* rgb = screen.at(x, y);
    return Color{rgb[0], rgb[1], rgb[2]};
  };
  const Color panel = pixel(shot(), 1240, 310);
  const auto menu = [&] {
    ASSERT_TRUE(user("mousemove 1245 142 click 1"));
    ASSERT_TRUE(until([&] {
      const Screen screen = shot();
      return !screen.rgb.empty() && pixel(screen, 1240, 310) != panel;
    }));
  };
  ASSERT_NO_FATAL_FAILURE(menu());
  ASSERT_TRUE(user("mousemove 1086 202 click 1"));
  EXPECT_TRUE(until_color(kX, kY, kQuartered)) << "twice";
  ASSERT_TRUE(user("mousemove 400 300 key ctrl+z"));
  EXPECT_TRUE(until_color(kX, kY, kHalved));
  ASSERT_NO_FATAL_FAILURE(menu());
  ASSERT_TRUE(user("mousemove 1072 298 click 1"));
  ASSERT_TRUE(until([&] {  // the list of masks is read, and lies beside the menu
    const Screen screen = shot();
    return !screen.rgb.empty() && pixel(screen, 1042, 478) == pixel(screen, 1240, 310);
  }));
  ASSERT_TRUE(user("mousemove 948 469 click 1"));
  ASSERT_TRUE(until([&] {
    return user("mousemove 400 300 key ctrl+s") && text_of("look.lua").find("mask.luma") != std::string::npos;
  })) << text_of("look.lua");
  EXPECT_NE(text_of("look.lua").find("  -- darker\n"), std::string::npos);
  ASSERT_TRUE(user("key ctrl+z"));
  EXPECT_TRUE(saved(kDarker)) << text_of("look.lua");
  quit();
}

TEST_F(PlayStack, ThePresetIsSavedAsAnother) {
  ASSERT_NO_FATAL_FAILURE(open(kDarker));
  ASSERT_TRUE(until_color(kX, kY, kHalved));
  ASSERT_TRUE(user("key Page_Down key ctrl+d"));
  ASSERT_TRUE(until_color(kX, kY, kQuartered));
  std::ofstream(folder_ / "other.lua") << "there";
  ASSERT_TRUE(user("key ctrl+shift+s type other"));
  ASSERT_TRUE(user("key Return"));
  ASSERT_TRUE(user("key Return"));  // it exists
  ASSERT_TRUE(program_->wait_for("opened other.lua"));
  EXPECT_EQ(text_of("other.lua"), begin + kDarker + "  fx.color_adjustments { post_exposure = -1 },\n" + end);
  EXPECT_EQ(text_of("look.lua"), begin + kDarker + end);
  EXPECT_TRUE(until_color(kX, kY, kQuartered));
  ASSERT_TRUE(user("key Page_Up key Delete"));  // the last one
  EXPECT_TRUE(until_color(kX, kY, kHalved));
  EXPECT_TRUE(saved(kDarker, "other.lua")) << "what is saved from here on is the other file";
  EXPECT_EQ(text_of("look.lua"), begin + kDarker + end);
  quit();
}

TEST_F(PlayStack, TheFileChangesMeanwhile) {
  // Thin letters have few pixels of the very colour: those near it count.
  const auto count = [&](int red_from, int red_to, int green_from, int green_to) {
    const Screen screen = shot();
    int out = 0;
    for (std::size_t i = 0; i + 2 < screen.rgb.size(); i += 3)
      out += screen.rgb[i] > red_from && screen.rgb[i] <= red_to && screen.rgb[i + 1] > green_from &&
             screen.rgb[i + 1] < green_to && screen.rgb[i + 2] < 110;
    return out;
  };
  ASSERT_NO_FATAL_FAILURE(open(kDarker));
  ASSERT_TRUE(until_color(kX, kY, kHalved));
  ASSERT_TRUE(user("key Page_Down key ctrl+d"));
  ASSERT_TRUE(until_color(kX, kY, kQuartered));
  const std::string theirs = begin + "  fx.color_adjustments { color_filter = { 0, 1, 0 } },\n" + end;
  std::ofstream(folder_ / "look.lua") << theirs;
  // In amber, in the panel's head; the picture stays the panel's.
  EXPECT_TRUE(until([&] { return count(200, 255, 160, 210) > 60; }));
  EXPECT_TRUE(has_color(shot(), kX, kY, kQuartered));
  ASSERT_TRUE(user("key ctrl+s"));
  EXPECT_TRUE(until([&] { return count(220, 255, 80, 115) > 60; })) << "why nothing was written";
  EXPECT_EQ(text_of("look.lua"), theirs);
  ASSERT_TRUE(user("key ctrl+BackSpace"));  // as the file has it
  EXPECT_TRUE(until_color(kX, kY, kGreen));
  quit();
}

}  // namespace
}  // namespace afterglow
