// SPDX-License-Identifier: MIT
// The further lines of an error, and the places that they name.
#include <gtest/gtest.h>

#include "window/error_lines.h"

namespace afterglow {
namespace {

Error error_with(std::vector<std::string> trail) {
  Error out{ErrorKind::script, "'d': undeclared identifier", "a.glsl", 2};
  out.trail = std::move(trail);
  return out;
}

TEST(ErrorLines, EachFurtherErrorHasItsPlace) {
  const auto lines = further_lines(error_with(
      {"dir/a b.glsl:12: 'x': undeclared identifier", "pack.zip:shaders/c.glsl:7: '': x:3: odd", "and 4 more"}));
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0].where, "dir/a b.glsl:12");
  EXPECT_EQ(lines[0].what, "'x': undeclared identifier");
  EXPECT_EQ(lines[0].place.file, "dir/a b.glsl");
  EXPECT_EQ(lines[0].place.line, 12);
  EXPECT_EQ(lines[1].where, "pack.zip:shaders/c.glsl:7") << "a colon without a number belongs to the name";
  EXPECT_EQ(lines[1].what, "'': x:3: odd");
  EXPECT_EQ(lines[2].where, "");
  EXPECT_EQ(lines[2].what, "and 4 more");
  EXPECT_TRUE(lines[2].place.file.empty());
}

TEST(ErrorLines, LinesThatLeadToAPlaceAreWhole) {
  const auto lines = further_lines(error_with({"included at lib/outer.glsl:2", "in effect 'glow' of my look.lua:4"}));
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].what, "included at lib/outer.glsl:2");
  EXPECT_EQ(lines[0].place.file, "lib/outer.glsl");
  EXPECT_EQ(lines[0].place.line, 2);
  EXPECT_EQ(lines[1].place.file, "my look.lua");
  EXPECT_EQ(lines[1].place.line, 4);
}

TEST(ErrorLines, NumbersThatAreNoLinesNameNothing) {
  for (const char* text : {"", ":3: x", "a:0: x", "a:99999999999999: x", "ratio 3:4", "a:", "a:3x: y"})
    EXPECT_TRUE(further_lines(error_with({text}))[0].place.file.empty()) << text;
}

TEST(ErrorLines, PlacesComeOnceInTheirOrder) {
  const auto places = error_places(error_with({"b.glsl:9: x", "a.glsl:2: another one there", "and 4 more"}));
  ASSERT_EQ(places.size(), 2u);
  EXPECT_EQ(places[0].file, "a.glsl");
  EXPECT_EQ(places[1].file, "b.glsl");
  EXPECT_TRUE(error_places(Error{ErrorKind::device, "lost"}).empty());
}

}  // namespace
}  // namespace afterglow
