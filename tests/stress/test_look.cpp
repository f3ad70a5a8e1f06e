// SPDX-License-Identifier: MIT
// A preset that is tried is the preset, as far as it can be taken apart.
#include "bad_effects.h"
#include "core/text.h"
#include "stress/look.h"

namespace afterglow::stress {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(StressLook, HasThePresetsMasksAndGroups) {
  const EffectFolder folder;
  std::vector<std::string> warnings;
  Diagnostics diagnostics([&](Severity severity, const std::string& message) {
    if (severity == Severity::warning) warnings.push_back(message);
  });
  const auto text_of = [&](const std::string& preset) {
    warnings.clear();
    folder.write("look.lua", preset);
    const auto look = look_of_preset(folder.path() / "look.lua", {}, {64, 64}, diagnostics);
    return look ? look->text() : look.error().text();
  };
  const std::string begin = "local fx = require \"afterglow\"\nreturn fx.stack {\n";
  const std::string text = text_of(begin + R"(
    fx.exposure { ev = 0.5, opacity = 0.25, blend = "screen", mask = 1 - fx.mask.linear { } * 0.5 },
    fx.group { fx.exposure { ev = 1 }, fx.vignette { enabled = false }, mask = fx.mask.luma { from = 2 } },
    fx.group { fx.exposure { ev = 2 }, enabled = false },
    fx.exposure { ev = 3 } })");
  EXPECT_THAT(warnings, testing::IsEmpty());
  for (const char* part : {"opacity = 0.25", "blend = \"screen\"", "mask = (1 - (fx.mask.linear { from = ",
                           "fx.group { ", "mask = fx.mask.luma { from = 2", "ev = 1 } }", "ev = 3"})
    EXPECT_THAT(text, HasSubstr(part));
  for (const char* part : {"vignette", "ev = 2"}) EXPECT_THAT(text, testing::Not(HasSubstr(part)));
  EXPECT_EQ(text_of(text), text) << "and that is the same look again";

  text_of(begin +
          "fx.exposure { ev = function(t) return t.frame end }, fx.mix { { fx.exposure { } }, { fx.vignette { } } } }");
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("settings that move are tried as they are in the first frame"),
                                    HasSubstr("'mix' is tried as a group")));
}

}  // namespace
}  // namespace afterglow::stress
