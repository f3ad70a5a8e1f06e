// SPDX-License-Identifier: MIT
// A setting of each type goes into the text of a preset, over a value and where none stood, and back to its default.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "edit/write_back.h"
#include "scene.h"

namespace afterglow::test {
namespace {

struct OfType {
  const char *name, *declared;
  SettingValue value;
  const char *before, *after;  ///< as they stand in the text
};

const OfType kTypes[] = {
    {"steps", "fx.int { default = 4, min = 0, max = 255 }", {SettingType::integer, {7}, ""}, "3", "7"},
    {"amount", "fx.float { default = 0.5, min = 0, max = 1 }", {SettingType::number, {0.25}, ""}, "0.75", "0.25"},
    {"soft", "fx.bool { default = false }", {SettingType::boolean, {1}, ""}, "false", "true"},
    {"mode", "fx.enum { \"a\", \"b\", \"c\", default = \"a\" }", {SettingType::enumeration, {}, "c"}, "\"b\"", "\"c\""},
    {"tint",
     "fx.color { default = { 1, 1, 1 } }",
     {SettingType::color, {0.5, 2, 0}, ""},
     "{ 1, 2, 3 }",
     "{ 0.5, 2, 0 }"},
    {"offset", "fx.vec2 { default = { 0, 0 } }", {SettingType::vec2, {3, -4}, ""}, "{ 1, 2 }", "{ 3, -4 }"},
    {"axis", "fx.vec3 { default = { 0, 0, 0 } }", {SettingType::vec3, {3, -4, 5}, ""}, "{ 1, 2, 3 }", "{ 3, -4, 5 }"},
    {"table",
     "fx.file { extensions = { \"cube\" } }",
     {SettingType::file, {}, "luts/b.cube"},
     "\"a.cube\"",
     "\"luts/b.cube\""},
    {"words",
     "fx.text { default = \"\" }",
     {SettingType::text, {}, "a \"b\"\nc\\d\t\b1"},
     "\"hero\"",
     "\"a \\\"b\\\"\\nc\\\\d\\t\\0081\""},
};

class WriteBackTypes : public ::testing::TestWithParam<OfType> {
 protected:
  WriteBackTypes() {
    scene.effect("glow", std::string("at = \"post_process\", settings = { ") + GetParam().name + " = " +
                             GetParam().declared + " },\n  build = function(g, s, source) return source end");
  }
  std::string edited(const std::string& arguments, const std::optional<SettingValue>& value) {
    const std::string head = "local fx = require \"afterglow\"\nreturn fx.stack { fx.glow ", tail = " }";
    const auto out = rewrite_preset(scene.folder() / "preset.lua", head + arguments + tail,
                                    {{"glow", GetParam().name, value}}, scene.options);
    if (!out) return out.error().text();
    if (!out->refused.empty()) return out->refused[0].reason.text();
    return out->text.substr(head.size(), out->text.size() - head.size() - tail.size());
  }
  std::string with(const char* value) const { return std::string("{ ") + GetParam().name + " = " + value + " }"; }
  Scene scene;
};

TEST_P(WriteBackTypes, GoThereAndBack) {
  const OfType& of = GetParam();
  EXPECT_EQ(edited(with(of.before), of.value), with(of.after));
  EXPECT_EQ(edited("{}", of.value), with(of.after));
  EXPECT_EQ(edited(with(of.before), std::nullopt), "{}");
}

INSTANTIATE_TEST_SUITE_P(All, WriteBackTypes, ::testing::ValuesIn(kTypes),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace afterglow::test
