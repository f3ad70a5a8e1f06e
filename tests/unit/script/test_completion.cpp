// SPDX-License-Identifier: MIT
// The completion file for lua-language-server. After a change of an effect's settings it is written anew by
//   AFTERGLOW_UPDATE=1 ctest --test-dir build -R Completion.FileIsUpToDate
#include <gtest/gtest.h>

#include <cstdlib>

#include "core/file.h"
#include "scene.h"

namespace afterglow::test {
namespace {

TEST(Completion, FileIsUpToDate) {
  Scene scene;
  SearchPath path;
  path.installation = AFTERGLOW_PROJECT_FOLDER;
  const auto effects = list_effects(path, scene.diagnostics);
  ASSERT_TRUE(effects) << effects.error().text();
  const auto masks = list_masks(path, scene.diagnostics);
  ASSERT_TRUE(masks) << masks.error().text();
  const std::string text = completion_text(*effects, *masks);
  const std::filesystem::path file = AFTERGLOW_PROJECT_FOLDER "/scripts/_meta/afterglow.lua";
  if (std::getenv("AFTERGLOW_UPDATE")) {
    ASSERT_TRUE(write_file_atomically(file, text));
  }
  const auto committed = read_file(file);
  ASSERT_TRUE(committed) << committed.error().text();
  EXPECT_EQ(*committed, text) << "run: AFTERGLOW_UPDATE=1 ctest -R Completion.FileIsUpToDate";
}

TEST(Completion, EachTypeHasItsForm) {
  EffectSchema glow;
  glow.name = "glow";
  glow.doc = "Makes light\nspread.";
  const auto add = [&](const char* name, SettingType type, double value) -> SettingSchema& {
    SettingSchema setting;
    setting.name = name;
    setting.doc = std::string("About ") + name + ".";
    setting.type = setting.default_value.type = type;
    setting.default_value.number = {value, value, value};
    return glow.settings.emplace_back(setting);
  };
  SettingSchema& mode = add("mode", SettingType::enumeration, 0);
  mode.choices = {"soft", "hard"};
  mode.default_value.choice = "hard";
  add("levels", SettingType::integer, 4).min = 1;
  SettingSchema& gain = add("gain", SettingType::number, 0.5);
  gain.min = 0;
  gain.max = 2;
  gain.unit = "EV";
  add("fade", SettingType::boolean, 1);
  add("tint", SettingType::color, 1).min = 0;
  add("shift", SettingType::vec2, 0).unit = "px";
  EffectSchema spot;
  spot.name = "spot";
  spot.doc = "A round place.";
  spot.settings.push_back(glow.settings[2]);
  const std::string text = completion_text({glow}, {spot});
  EXPECT_TRUE(text.starts_with("---@meta _\n"));
  EXPECT_NE(text.find(R"(
---Makes light spread.
---@class afterglow.settings.glow : afterglow.EntryKeys
---@field mode? "soft"|"hard"|afterglow.OfTime  About mode. default "hard"
---@field levels? integer|afterglow.Moving  About levels. integer ≥ 1, default 4
---@field gain? number|afterglow.Moving  About gain. 0…2 EV, default 0.5
---@field fade? boolean|afterglow.OfTime  About fade. default true
---@field tint? number[]|string|afterglow.Moving  About tint. {r, g, b} with numbers ≥ 0, "#rrggbb", default {1, 1, 1}
---@field shift? number[]|afterglow.Moving  About shift. px, default {0, 0}

---A round place.
---@class afterglow.masks.spot : afterglow.MaskKeys
---@field gain? number|afterglow.Moving  About gain. 0…2 EV, default 0.5

---@class afterglow
---@field glow fun(settings: afterglow.settings.glow): afterglow.Entry  Makes light spread.

---What `fx.mask` holds; masks of yours are masks/NAME.lua.
---@class afterglow.Masks
---@field spot fun(settings: afterglow.masks.spot): afterglow.Mask  A round place.
)"),
            std::string::npos)
      << text;
}

TEST(Completion, TheFileIsValidLua) {
  const auto text = read_file(AFTERGLOW_PROJECT_FOLDER "/scripts/_meta/afterglow.lua");
  ASSERT_TRUE(text);
  Scene scene;
  scene.write("meta.lua", *text);
  scene.preset("require \"meta\"\nreturn require(\"afterglow\").stack {}");
  EXPECT_EQ(scene.load_error(), "");
}

}  // namespace
}  // namespace afterglow::test
