// SPDX-License-Identifier: MIT
// Settings as widgets: what is typed, where sliders go, codes of colours.
#include <gtest/gtest.h>

#include "window/setting_widget.h"

namespace afterglow::test {
namespace {

TEST(TypedValue, TakesAsManyNumbersAsTheTypeHas) {
  SettingSchema schema;
  schema.type = SettingType::vec3;
  EXPECT_EQ(parse_typed(schema, "1, 2.5 -3e-2")->number, (std::array<double, 3>{1, 2.5, -0.03}));
  EXPECT_EQ(parse_typed(schema, "0.5")->number, (std::array<double, 3>{0.5, 0.5, 0.5}));
  EXPECT_FALSE(parse_typed(schema, "1 2"));
  EXPECT_FALSE(parse_typed(schema, "1 2 x"));
  EXPECT_FALSE(parse_typed(schema, "1 2 nan"));
  schema.type = SettingType::integer;
  schema.max = 7;
  EXPECT_EQ(parse_typed(schema, "99")->number[0], 7);
  EXPECT_EQ(parse_typed(schema, "2.6")->number[0], 3);
  EXPECT_FALSE(parse_typed(schema, ""));
}

TEST(SettingWidget, SlidersByFactorsWhereTheRangeIsWide) {
  SettingSchema schema;
  EXPECT_FALSE(is_logarithmic(schema));
  schema.min = 0;
  schema.max = 1;
  EXPECT_FALSE(is_logarithmic(schema));
  schema.max = 1000;
  EXPECT_TRUE(is_logarithmic(schema));
  schema.min = -1000;
  EXPECT_FALSE(is_logarithmic(schema));
  schema.unit = "EV";
  EXPECT_TRUE(is_logarithmic(schema)) << "to both sides of 0";
  schema.unit = "";
  schema.min = 0;
  schema.type = SettingType::vec2;
  EXPECT_TRUE(is_logarithmic(schema));
  schema.max = 100;
  EXPECT_FALSE(is_logarithmic(schema)) << "its default is 0";
  schema.default_value.number = {1, 0.5};
  EXPECT_TRUE(is_logarithmic(schema)) << "the default would be a hundredth of the slider from its end";
  schema.type = SettingType::number;
  EXPECT_TRUE(is_logarithmic(schema));
  schema.default_value.number = {10};
  EXPECT_FALSE(is_logarithmic(schema));
  schema.type = SettingType::integer;
  schema.default_value.number = {1};
  EXPECT_FALSE(is_logarithmic(schema));
}

}  // namespace
}  // namespace afterglow::test
