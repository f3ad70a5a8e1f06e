// SPDX-License-Identifier: MIT
// Text over the picture: each pixel as the oracle has it, what the words in braces become, what is refused.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "cases.h"
#include "reference/burn_in.h"

namespace afterglow {
namespace {

using namespace reference;
using ::testing::HasSubstr;

std::string color_text(const Rgb& c) { return fmt::format("{{ {}, {}, {} }}", c.r, c.g, c.b); }

EffectCase burnt(const std::string& text, const BurnIn& v) {
  return {
      fmt::format("fx.burn_in {{ text = \"{}\", position = {{ {}, {} }}, size = {}, margin = {}, color = {}, "
                  "background = {}, box = {}, outline = {} }}",
                  text, v.x, v.y, v.size, v.margin, color_text(v.color), color_text(v.background), v.box, v.outline),
      [=](const Scene& s) { return burn_in(s.source, v); }};
}

TEST_F(Effects, BurnInAgrees) {
  agree_everywhere({burnt("Ab 0129", {U"Ab 0129"}), burnt("x", {.text = U"x", .size = 1, .margin = 0}),
                    burnt("Ærø\\nПуть €\\n\\n字.", {.text = U"Ærø\nПуть €\n\n字.", .x = 0.1, .y = 0.4, .size = 0.2}),
                    burnt("Wigj_ÅÄÇ_W/Ä\\nÉq", {.text = U"Wigj_ÅÄÇ_W/Ä\nÉq",
                                                .x = 1,
                                                .y = 0,
                                                .size = 0.3,
                                                .margin = 0.1,
                                                .color = {4, 0.5, 0},
                                                .background = {0, 0.25, 1},
                                                .box = 0.3,
                                                .outline = 0.1})},
                   {.full = 1e-3, .fused = 1e-5, .half = 2e-2});
  expect_skipped("fx.burn_in { text = \"\" }", "text is empty");
}

/// What is made of a text in place of one without braces.
bool same(const std::string& text, const std::string& plain, Scene scene, int frame) {
  scene.frame = frame;
  const auto entry = [](const std::string& of) {
    return fmt::format("fx.burn_in {{ size = 0.2, text = \"{}\" }}", of);
  };
  return run_stack(entry(text), scene, Way::plain).result == run_stack(entry(plain), scene, Way::plain).result;
}

TEST_F(Effects, BurnInFillsInTheFrame) {
  const Scene scene = random_scene({160, 90}, 3);
  EXPECT_TRUE(same("{frame}", "0042", scene, 42));
  EXPECT_TRUE(same("a{frame}b {timecode}", "a90001b 01:02:30:00", scene, 90001));
  EXPECT_TRUE(same("{timecode}", "00:00:01:18", scene, 43)) << "frame 1 is at time 0 here";
  EXPECT_TRUE(same("{time}", "1.750", scene, 43));
  EXPECT_TRUE(same("{", "{", scene, 42));
  EXPECT_TRUE(same("{{frame}} {3} {}", "{0042} {3} {}", scene, 42));
  EXPECT_TRUE(same("a\\r\\nbe\\xCC\\x81", "a\\nbe", scene, 42));
  EXPECT_FALSE(same("{frame}", "0043", scene, 42));
  // Bytes that are no letters, and letters that are cut off or lie beyond the picture, are squares.
  EXPECT_TRUE(same("a\\xB1\\xCAb\\xE2\\x82c\\xF0\\x9F\\x98\\x80\\xC1\\xC3", "a□□b□c□□□", scene, 42));
  EXPECT_FALSE(same("□", "x", scene, 42));
}

/// Every time code of eleven minutes, counted as clocks do, and back.
TEST_F(Effects, TimeCodesDropTheRightNumbers) {
  const std::string count = R"((function()
    local time_code = require "lib.time_code"
    for fps, drop in pairs { [24] = 0, [30] = 0, [30000 / 1001] = 2, [59.94] = 4 } do
      local rate = math.floor(fps + 0.5)
      local h, m, s, f, mark = 0, 0, 0, 0, drop > 0 and ";" or ":"
      for n = 0, rate * 660 do
        local code = ("%02d:%02d:%02d%s%02d"):format(h, m, s, mark, f)
        assert(time_code.text(n, fps, drop > 0) == code, code)
        local back, drops = time_code.parse(code, fps)
        assert(back == n and drops == (drop > 0), code)
        f = f + 1
        if f == rate then f, s = 0, s + 1 end
        if s == 60 then s, m, f = 0, m + 1, (m + 1) % 10 == 0 and 0 or drop end
      end
    end
    assert(time_code.text(-1, 25, false) == "23:59:59:24" and time_code.text(-1, 29.97, true) == "23:59:59;29")
    assert(time_code.text(107892, 29.97, true) == "01:00:00;00" and time_code.parse("01:00:00;00", 29.97) == 107892)
    for _, fps in ipairs { 23.976, 25, 30, 60 } do assert(not time_code.parse("01:00:00;00", fps)) end
    assert(not time_code.parse("00:01:00;00", 29.97) and time_code.parse("00:10:00;00", 29.97))
    for _, bad in ipairs { "", "1:00:00:00", "01:00:00:24", "24:00:00:00", "01:60:00:00", "01:00:61:00", "01-00:00:00", "aa:00:00:00", "01:00:00:000" } do
      assert(not time_code.parse(bad, 24), bad)
    end
    return fx.exposure { ev = 1 }
  end)())";
  EXPECT_TRUE(run_stack(count, random_scene({4, 4}, 3), Way::plain).ran());
}

TEST_F(Effects, BurnInSaysWhatItCannotShow) {
  const Scene scene = random_scene({64, 64}, 3);
  EXPECT_THAT(build_error("fx.burn_in { text = \"take {shot}\" }", scene),
              HasSubstr("text: {shot} is none of {frame}, {time}, {timecode}"));
  EXPECT_THAT(build_error("fx.burn_in { text = (\"x\"):rep(128) .. \"\\n\\n\" }", scene),
              HasSubstr("text: 3 lines of up to 128 letters are 384; at most 256 fit"));
  EXPECT_THAT(build_error("fx.burn_in { text = \"{timecode}\", start = \"01:00\" }", scene),
              HasSubstr("start: \"01:00\" is no time code at 24 frames a second"));
}

}  // namespace
}  // namespace afterglow
